#include "services/fleetctl/campaign/campaign_identity.h"

#include <elf.h>
#include <fmt/format.h>
#include <link.h>

#include <cstdint>
#include <cstring>
#include <string_view>

#include "services/types/state_hash.h"

namespace giveway::fleetctl {
namespace {

// FNV-1a, as for every other printed hash.
std::string HashOf(std::string_view text) {
  StateHash hash;
  for (const char c : text) hash.Add(std::uint64_t{static_cast<unsigned char>(c)});
  return fmt::format("{:016x}", hash.Value());
}

template <typename Range>
std::string RangeText(const Range& range) {
  return range.low == range.high ? fmt::format("{}", range.low)
                                 : fmt::format("{}..{}", range.low, range.high);
}

std::size_t Padded(std::size_t bytes) { return (bytes + 3) & ~std::size_t{3}; }

// The build id among the notes; they are aligned to four bytes.
std::string BuildIdIn(const char* notes, std::size_t size) {
  std::string id;
  for (std::size_t at = 0; at + sizeof(ElfW(Nhdr)) <= size;) {
    ElfW(Nhdr) note;
    std::memcpy(&note, notes + at, sizeof note);
    const std::size_t name = at + sizeof note;
    const std::size_t content = name + Padded(note.n_namesz);
    if (content + note.n_descsz > size) break;
    if (note.n_type == NT_GNU_BUILD_ID && note.n_namesz == 4 &&
        std::memcmp(notes + name, "GNU", 4) == 0) {
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
    const std::string id = BuildIdIn(notes, part.p_memsz);
    if (!id.empty()) *static_cast<std::string*>(found) = id;
  }
  return 1;
}

}  // namespace

std::string ShellWord(const std::string& text) {
  constexpr std::string_view kPlain =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_-./+,:@%";
  if (text.find_first_not_of(kPlain) == std::string::npos) return text;
  std::string word = "'";
  for (const char c : text) word += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return word + "'";
}

std::string CanonicalText(const CampaignPlan& plan) {
  std::string text = fmt::format("campaign {}\n", plan.name);
  for (const std::string& generator : plan.generators) {
    text += fmt::format("generator {}\n", generator);
  }
  if (plan.vehicles)
    text += fmt::format("vehicles {}..{}\n", plan.vehicles->low, plan.vehicles->high);
  if (plan.duration_s) text += fmt::format("duration {}\n", *plan.duration_s);
  text += fmt::format("seeds {}..{}\nloss {}..{}\nburst {:d}\n", plan.seeds.low, plan.seeds.high,
                      plan.loss_percent.low, plan.loss_percent.high, plan.burst);
  text +=
      fmt::format("delay {}\njitter {}\nreorder {}\nduplicate {}\nloopback {:d}\n", plan.delay_ms,
                  plan.jitter_ms, plan.reorder_percent, plan.duplicate_percent, plan.loops_back);
  text += fmt::format("crashes {}\npauses {}\nrestarts {}\nskip_unsupported {:d}\n", plan.crashes,
                      plan.pauses, plan.restarts, plan.skip_unsupported);
  // With its length, so that a text cannot be taken for a part of the next.
  text += fmt::format("scenario {}\n{}\n", plan.scenario_text.size(), plan.scenario_text);
  return text + fmt::format("faults {}\n{}", plan.fault_file, plan.fault_text);
}

std::string PlanHash(const CampaignPlan& plan) { return HashOf(CanonicalText(plan)); }

std::string FlagsOf(const CampaignPlan& plan) {
  std::string flags;
  if (plan.vehicles) flags += " --vehicles " + RangeText(*plan.vehicles);
  if (plan.duration_s) flags += fmt::format(" --duration {}", *plan.duration_s);
  const auto add = [&](const char* flag, double value) {
    if (value > 0) flags += fmt::format(" {} {}", flag, value);
  };
  if (plan.loss_percent.high > 0) flags += " --loss " + RangeText(plan.loss_percent);
  if (plan.burst) flags += " --burst";
  add("--delay", plan.delay_ms);
  add("--jitter", plan.jitter_ms);
  add("--reorder", plan.reorder_percent);
  add("--duplicate", plan.duplicate_percent);
  if (plan.loops_back) flags += " --loopback";
  add("--crashes", plan.crashes);
  add("--pauses", plan.pauses);
  add("--restarts", plan.restarts);
  if (!plan.fault_file.empty()) flags += " --faults " + ShellWord(plan.fault_file);
  if (plan.skip_unsupported) flags += " --skip-unsupported";
  return flags;
}

std::string ProgramId() {
  std::string id;
  ::dl_iterate_phdr(ReadBuildId, &id);
  return id;
}

}  // namespace giveway::fleetctl
