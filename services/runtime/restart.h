// A process that restarts in place with other flags: the same process id, pipes and parent, but a
// new program image, because the library keeps the first profiles it loads until the process ends.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace giveway {

// Flags by name, "--qos", and their values.
using NewFlags = std::map<std::string, std::string>;

// The command line with these flags instead of what it said of them; one with an empty value is
// left out.
std::vector<std::string> ArgumentsWith(const std::vector<std::string>& arguments,
                                       const NewFlags& flags);

// The command line that this process was started with. Needs no descriptor.
std::vector<std::string> OwnArguments();

// From now on a stop signal waits for the next process image instead of being forgotten by it. What
// came before is for the caller to look at.
void HoldSignalsBack();
// The descriptors of held texts, in rising order.
std::vector<int> HeldDescriptors();
// Of the descriptors open now only the standard ones and held texts outlive an exec.
void LeaveOpenOnlyHeld();

// Replaces this process. Nothing is destroyed: whatever must be closed is closed before. Throws
// std::system_error.
[[noreturn]] void RestartWith(const NewFlags& flags);

// A text in memory behind a descriptor. Throws std::system_error.
class HeldText {
 public:
  HeldText(const std::string& name, const std::string& text);
  ~HeldText();
  HeldText(const HeldText&) = delete;
  HeldText& operator=(const HeldText&) = delete;
  int Descriptor() const { return descriptor_; }
  std::string Path() const;

 private:
  int descriptor_;
};

// The name is cut to what the system takes. Keeps a text in memory under a path that a restarted
// process still finds; a container's file system may be read-only. Throws std::system_error.
std::string HoldText(const std::string& name, const std::string& text);
// Holds a text for the next process image, which finds its path in this flag. Where no descriptor
// or memory is left that is logged, false is returned and `flags` stay as they are: if the flag is
// not among them, what the command line says of it holds.
bool HoldTextFor(const std::string& flag, const std::string& name, const std::string& text,
                 NewFlags* flags);
// The file's name, for people; of a held text the name it was given.
std::string NameOf(const std::string& path);
// A held text that has been read goes with this process image; any other path is left alone.
void LetGo(const std::string& path);
// The next process image reads it again after all, from the same path.
void HoldAgain(const std::string& path);

}  // namespace giveway
