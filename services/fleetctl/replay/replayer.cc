#include "services/fleetctl/replay/replayer.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "services/runtime/utf8.h"
#include "services/snapshot/brain_state.h"

namespace giveway::fleetctl {
namespace {

std::optional<FieldDifference> Compare(const RecordedStep& recorded, const Outputs& replayed,
                                       std::uint64_t hash) {
  if (auto difference = FirstDifference(recorded.outputs, replayed)) return difference;
  if (recorded.hash == hash) return std::nullopt;
  return FieldDifference{"hash", fmt::format("{:016x}", recorded.hash),
                         fmt::format("{:016x}", hash)};
}

constexpr std::size_t kMostFailureBytes = 200;

}  // namespace

void Replayer::Begin(const RecordingFile& file, ReplayedFile* outcome) {
  if (file.Life()) {
    const RecordedLife& life = *file.Life();
    brain_.emplace(life.options, life.boot_epoch);
    if (life.handover) brain_->TakeOver(*life.handover);
    next_ = {life.boot_epoch, life.options.id, 1, 0};
    outcome->vehicle = life.options.id;
    return;
  }
  outcome->vehicle = file.Continues()->vehicle;
  outcome->part = file.Continues()->part;
  if (brain_ && *file.Continues() == next_) return;
  brain_.reset();  // an image must restore one
  next_ = *file.Continues();
}

// Restores the brain with which a part of a ring starts. Or, if one was replayed up to there,
// compares the two: a mismatch is outcome->difference. Returns why the image cannot be used; empty:
// it can.
std::string Replayer::TakeImage(const RecordedImage& image, ReplayedFile* outcome) {
  if (brain_) {
    if (AreBytesOf(image.state, brain_->State())) return "";
    outcome->difference = {
        outcome->steps,
        brain_->State().world.tick,
        {"state", fmt::format("{:016x}", image.hash), fmt::format("{:016x}", brain_->Hash())}};
    return "";
  }
  const auto state = StateFrom(image.state, image.options);
  if (state == nullptr) return "starts from a vehicle state that this program cannot restore";
  brain_.emplace(image.options, next_.boot_epoch);
  brain_->Restore(*state);
  if (brain_->Hash() == image.hash) return "";
  brain_.reset();
  return "starts from a vehicle state that differs from the recorded hash";
}

ReplayedFile Replayer::Replay(std::istream* part, const ReplayWatcher& watch) {
  RecordingFile file(part);
  ReplayedFile outcome;
  outcome.finding = file.Complaint();
  if (!file.Life() && !file.Continues()) return outcome;
  Begin(file, &outcome);
  Lead(&file, watch, &outcome);
  const bool continues = file.End() && file.End()->continues && !outcome.difference;
  if (!continues || !outcome.finding.empty()) brain_.reset();
  ++next_.part;
  next_.steps_before += outcome.steps;
  return outcome;
}

void Replayer::Lead(RecordingFile* file, const ReplayWatcher& watch, ReplayedFile* outcome) {
  bool compared_image = false;
  while (const std::optional<Record> record = file->Next()) {
    if (const auto* image = std::get_if<RecordedImage>(&*record)) {
      compared_image = brain_.has_value();
      outcome->finding = TakeImage(*image, outcome);
      if (!outcome->finding.empty() || outcome->difference) return;
      continue;
    }
    if (!brain_) {
      outcome->finding = fmt::format(
          "is part {} of a recording: name the parts before it, too, each whole", outcome->part);
      return;
    }
    if (const auto* reseat = std::get_if<RecordedReseat>(&*record)) {
      brain_->Reseat(reseat->options);
      continue;
    }
    const auto& step = std::get<RecordedStep>(*record);
    const Outputs replayed = brain_->Step(step.AsInputs());
    if (watch) watch(step, *brain_, replayed);
    if (auto difference = Compare(step, replayed, brain_->Hash())) {
      outcome->difference = {outcome->steps + 1, brain_->State().world.tick,
                             std::move(*difference)};
      return;
    }
    ++outcome->steps;
  }
  outcome->finding = file->Complaint();
  const std::optional<RecordedEnd>& end = file->End();
  outcome->complete = end.has_value();
  outcome->lost = end ? end->lost : 0;
  outcome->failure = end ? Printable(Shortened(end->failure, kMostFailureBytes)) : "";
  // A ring may have started a file just before it ended. Without steps, the comparison of its image
  // with the brain that was replayed up to there is enough.
  if (outcome->steps == 0 && outcome->finding.empty() && !compared_image) {
    outcome->finding = "holds no step: nothing was compared";
    if (!outcome->failure.empty()) outcome->finding += "; " + outcome->failure;
  } else if (end && end->steps != outcome->steps) {
    outcome->finding = fmt::format("says it holds {} steps", end->steps);
  }
}

ReplayedFile Replay(std::istream* recording, const ReplayWatcher& watch) {
  return Replayer().Replay(recording, watch);
}

}  // namespace giveway::fleetctl
