// Files that are read and written whole or not at all. They are written first under a temporary
// name in the same folder, then renamed: a reader finds what was there before or all of what is
// new, never a part, whatever fails.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace giveway {

// Nothing where it cannot be read to its end, and errno says why: not there, a folder, or of a
// process in /proc that ended meanwhile.
std::optional<std::string> ReadWholeFile(const std::filesystem::path& path);

// These three: empty, or why not, and then errno is that of the failure.
//
// Empty if it is written, else why not. For the state of a process: what is at `path` is replaced,
// a symbolic link itself and not the file it leads to. It survives the death of the process at any
// moment, and does not wait for the disk.
std::string WriteStateFile(const std::string& path, std::string_view bytes);

// The same for a file that was asked for by name: a link is followed, and what is no regular file
// (a device, a pipe) or is reached through a descriptor (/dev/stdout, /dev/fd/3) is written to as
// it is. Waits for the disk.
std::string WriteOutputFile(const std::string& path, std::string_view bytes);

// Empty if WriteOutputFile could start now, else why not. Leaves no file behind.
std::string WhyNotWritable(const std::string& path);

// "path: cannot be read: No such file or directory", by errno.
std::string FileComplaint(const std::string& path, const char* what);

}  // namespace giveway
