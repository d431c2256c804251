#include "services/fleetctl/soak/host_faults/second_claim.h"

#include <utility>

namespace giveway::fleetctl {
namespace {

// The reason of the world, in sim_world/run/roster.cc, which a vehicle puts into its log.
constexpr std::string_view kRefused = " is taken by another session";

}  // namespace

void SecondClaim::NoteLine(std::string_view line) {
  refused_ = refused_ || line.find(kRefused) != std::string_view::npos;
}

void SecondClaim::NoteFaultOver(SteadyTime now) {
  ended_ = now;
  awaited_ = !world_was_away_;
}

bool SecondClaim::IsOver(SteadyTime now) const {
  return ended_ && (refused_ || !awaited_ || now >= *ended_ + kAnswerAfterEnd);
}

bool SecondClaim::IsCutShort(const faults::Target& own, const faults::Target& by) const {
  using What = faults::Target::What;
  return ended_ && !refused_ && (by == own || by.what == What::kWorld || by.what == What::kAll);
}

void SecondClaims::Begin(const faults::Fault& fault, std::unique_ptr<ChildProcess> process) {
  claims_[&fault] = {std::move(process), {}};
}

void SecondClaims::End(const faults::Fault& fault, SteadyTime now) {
  const auto claim = claims_.find(&fault);
  if (claim != claims_.end()) claim->second.course.NoteFaultOver(now);
}

// What is over was so already when its effect was last asked for.
void SecondClaims::Turn(SteadyTime now, bool world_answers) {
  std::erase_if(claims_, [now](const auto& claim) { return claim.second.course.IsOver(now); });
  for (auto& [fault, claim] : claims_) {
    claim.process->Poll();
    for (const std::string& line : claim.process->LastLines()) claim.course.NoteLine(line);
    if (!world_answers) claim.course.NoteWorldAway();
  }
}

std::vector<const faults::Fault*> SecondClaims::CutShort(const faults::Fault& by) {
  std::vector<const faults::Fault*> unanswered;
  std::erase_if(claims_, [&](const auto& claim) {
    if (!claim.second.course.IsCutShort(claim.first->target, by.target)) return false;
    unanswered.push_back(claim.first);
    return true;
  });
  return unanswered;
}

std::string SecondClaims::EffectOf(const faults::Fault& fault) const {
  const auto claim = claims_.find(&fault);
  if (claim == claims_.end() || !claim->second.course.IsRefused()) return {};
  return "the world refused its id to a second process";
}

std::string SecondClaims::WhyNothing(const faults::Fault& fault) const {
  const auto claim = claims_.find(&fault);
  if (claim == claims_.end() || !claim->second.course.WorldWasAway()) return {};
  return "the world was away, and refused nothing";
}

}  // namespace giveway::fleetctl
