#include "services/app/impair_fields.h"

#include <fmt/format.h>

#include <array>

namespace giveway::app {
namespace {

constexpr Allowed kProbability{0, 1};
constexpr Allowed kDelay{0, 10000, "ms"};

constexpr std::array kFields = {
    ImpairField{"loss", "loss", &ImpairmentRule::loss, kProbability},
    ImpairField{"burst", "burst", &ImpairmentRule::burst, {0, 0.9}},
    ImpairField{
        "burst_length", "burst_length", &ImpairmentRule::burst_length, {1, 10000, "packets"}},
    ImpairField{"burst_loss", "burst_loss", &ImpairmentRule::burst_loss, kProbability},
    ImpairField{"delay_ms", "delay", &ImpairmentRule::delay_s, kDelay, 1000, true},
    ImpairField{"jitter_ms", "jitter", &ImpairmentRule::jitter_s, kDelay, 1000, true},
    ImpairField{"reorder", "reorder", &ImpairmentRule::reorder, kProbability},
    ImpairField{"reorder_by_ms",
                "reorder_by",
                &ImpairmentRule::reorder_by_s,
                {0, 10000, "ms", true},
                1000,
                true},
    ImpairField{"duplicate", "duplicate", &ImpairmentRule::duplicate, kProbability},
    ImpairField{"corrupt", "corrupt", &ImpairmentRule::corrupt, kProbability},
    ImpairField{"rate_bytes_s", "rate", &ImpairmentRule::rate_bytes_s, {0, 1e9, "bytes/s"}},
    ImpairField{
        "rate_burst_bytes", "rate_burst", &ImpairmentRule::rate_burst_bytes, {1, 1e9, "bytes"}},
};

}  // namespace

std::span<const ImpairField> ImpairFields() { return kFields; }

std::vector<RuleConflict> ConflictsIn(const ImpairmentRule& rule) {
  std::vector<RuleConflict> conflicts;
  if (rule.jitter_s > rule.delay_s) {
    conflicts.push_back({"jitter_ms",
                         fmt::format("a jitter of {} ms is more than the delay of {} ms: packets "
                                     "would come before they are sent",
                                     rule.jitter_s * 1000, rule.delay_s * 1000),
                         "raise the delay or lessen the jitter"});
  }
  if (rule.burst > (1 - rule.burst) * rule.burst_length) {
    conflicts.push_back(
        {"burst",
         fmt::format("with bad times of {} packets at most {:.3g} can be bad", rule.burst_length,
                     rule.burst_length / (1 + rule.burst_length)),
         "lower burst or raise burst_length"});
  }
  return conflicts;
}

}  // namespace giveway::app
