#include "services/fleetctl/process/program_id.h"

#include <elf.h>
#include <fmt/format.h>
#include <link.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <optional>
#include <string_view>

namespace giveway::fleetctl {
namespace {

std::size_t Padded(std::size_t bytes) { return (bytes + 3) & ~std::size_t{3}; }

// The build id among the notes; they are aligned to four bytes.
std::string BuildIdIn(std::string_view notes) {
  std::string id;
  for (std::size_t at = 0; at + sizeof(ElfW(Nhdr)) <= notes.size();) {
    ElfW(Nhdr) note;
    std::memcpy(&note, notes.data() + at, sizeof note);
    const std::size_t name = at + sizeof note;
    const std::size_t content = name + Padded(note.n_namesz);
    if (content + note.n_descsz > notes.size()) break;
    if (note.n_type == NT_GNU_BUILD_ID && note.n_namesz == 4 &&
        std::memcmp(notes.data() + name, "GNU", 4) == 0) {
      for (std::size_t i = 0; i < note.n_descsz; ++i) {
        id += fmt::format("{:02x}", static_cast<unsigned char>(notes[content + i]));
      }
      return id;
    }
    at = content + Padded(note.n_descsz);
  }
  return id;
}

// Called for the program first, then for each library: 1 stops the iteration.
int ReadBuildId(dl_phdr_info* object, std::size_t /*size*/, void* found) {
  for (int i = 0; i < object->dlpi_phnum; ++i) {
    const ElfW(Phdr)& part = object->dlpi_phdr[i];
    if (part.p_type != PT_NOTE) continue;
    // The loader gives addresses as numbers. NOLINTNEXTLINE(performance-no-int-to-ptr)
    const auto* notes = reinterpret_cast<const char*>(object->dlpi_addr + part.p_vaddr);
    const std::string id = BuildIdIn({notes, part.p_memsz});
    if (!id.empty()) *static_cast<std::string*>(found) = id;
  }
  return 1;
}

// Up to `size` bytes of a file from `offset` on; fewer where it ends before.
std::string BytesAt(std::ifstream& file, std::uint64_t offset, std::size_t size) {
  std::string bytes(size, '\0');
  file.clear();
  file.seekg(static_cast<std::streamoff>(offset));
  file.read(bytes.data(), static_cast<std::streamsize>(size));
  bytes.resize(static_cast<std::size_t>(file.gcount()));
  return bytes;
}

template <typename Header>
std::optional<Header> HeaderAt(std::ifstream& file, std::uint64_t offset) {
  const std::string bytes = BytesAt(file, offset, sizeof(Header));
  Header header;
  if (bytes.size() != sizeof header) return std::nullopt;
  std::memcpy(&header, bytes.data(), sizeof header);
  return header;
}

}  // namespace

std::string ProgramId() {
  std::string id;
  ::dl_iterate_phdr(ReadBuildId, &id);
  return id;
}

std::string ProgramIdOf(const std::filesystem::path& file) {
  constexpr std::size_t kMostNotes = 65536;  // bytes; a build id takes 36
  std::ifstream program(file, std::ios::binary);
  const auto header = HeaderAt<ElfW(Ehdr)>(program, 0);
  if (!header || std::memcmp(header->e_ident, ELFMAG, SELFMAG) != 0 ||
      header->e_phentsize != sizeof(ElfW(Phdr))) {
    return "";
  }
  for (std::uint64_t i = 0; i < header->e_phnum; ++i) {
    const auto part = HeaderAt<ElfW(Phdr)>(program, header->e_phoff + i * sizeof(ElfW(Phdr)));
    if (!part) return "";
    if (part->p_type != PT_NOTE) continue;
    const std::size_t size = std::min<std::size_t>(part->p_filesz, kMostNotes);
    const std::string id = BuildIdIn(BytesAt(program, part->p_offset, size));
    if (!id.empty()) return id;
  }
  return "";
}

}  // namespace giveway::fleetctl
