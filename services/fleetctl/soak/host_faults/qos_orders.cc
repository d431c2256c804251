#include "services/fleetctl/soak/host_faults/qos_orders.h"

#include <fmt/format.h>

#include <chrono>
#include <utility>

#include "services/qos/profile_edit.h"
#include "services/qos/profile_set.h"
#include "services/qos/xml_tree.h"

namespace giveway::fleetctl {
namespace {

constexpr Nanoseconds kBeforeAgain = std::chrono::seconds(2);
constexpr ProcessEnd kNotStarted{.by_signal = false, .number = 127};  // as a shell says it

}  // namespace

std::optional<QosOrder> QosOrderCourse::Due(SteadyTime now) const {
  if (given_ || now < not_before_) return std::nullopt;
  if (fault_over_) return back_left_ > 0 ? std::optional(QosOrder::kTakeBack) : std::nullopt;
  return taken_ ? std::nullopt : std::optional(QosOrder::kTake);
}

void QosOrderCourse::NoteGiven(QosOrder order) { given_ = order; }

void QosOrderCourse::NoteEnd(bool in_effect, SteadyTime now) {
  const bool back = given_ == QosOrder::kTakeBack;
  given_.reset();
  if (back) {
    back_left_ = in_effect ? 0 : back_left_ - 1;
  } else {
    taken_ = in_effect;
  }
  if (!in_effect) not_before_ = now + kBeforeAgain;
}

QosOrders::QosOrders(std::vector<std::string> verb, std::string own_set)
    : verb_(std::move(verb)), own_set_(std::move(own_set)) {}

void QosOrders::Begin(const faults::Fault& fault, const std::string& set, const std::string& to) {
  ordered_[&fault] = {.set = set, .to = to};
}

void QosOrders::End(const faults::Fault& fault) {
  const auto found = ordered_.find(&fault);
  if (found != ordered_.end()) found->second.course.NoteFaultOver();
}

void QosOrders::Turn(SteadyTime now) {
  for (auto& [fault, ordered] : ordered_) {
    if (ordered.process) {
      ordered.process->Poll();
      if (ordered.process->IsRunning()) continue;
      const ProcessEnd how = *ordered.process->End();
      const auto& said = ordered.process->LastLines();
      ended_.push_back({fault, ordered.order, how, said.empty() ? std::string() : said.back()});
      ordered.process.reset();
      ordered.course.NoteEnd(how == ProcessEnd{}, now);
    }
    const std::optional<QosOrder> due = ordered.course.Due(now);
    if (!due) continue;
    ordered.order = *due;
    ordered.course.NoteGiven(*due);
    try {
      ordered.process = Start(ordered);
    } catch (const StartError& error) {
      ended_.push_back({fault, *due, kNotStarted, error.what()});
      ordered.course.NoteEnd(false, now);
    }
  }
  std::erase_if(ordered_, [](const auto& entry) { return entry.second.course.IsOver(); });
}

std::vector<QosOrders::Ended> QosOrders::TakeEnded() { return std::exchange(ended_, {}); }

std::unique_ptr<ChildProcess> QosOrders::Start(const Ordered& ordered) const {
  ChildCommand command;
  command.name = fmt::format("order to {}", ordered.to);
  command.words = verb_;
  const std::string& set = ordered.order == QosOrder::kTake ? ordered.set : own_set_;
  command.words.insert(command.words.end(), {set, "--to", ordered.to});
  return std::make_unique<ChildProcess>(command);
}

std::string WithPatientReaders(const std::string& text, const std::string& file) {
  const qos::XmlRead read = qos::ReadXml(text, file);
  if (!read.root) return {};
  std::vector<qos::ProfileEdit> edits;
  for (const qos::Profile& profile : qos::ReadProfiles(*read.root, file).profiles) {
    const qos::Value& deadline = profile[qos::Policy::kDeadline];
    const bool finite = deadline.given && deadline.number <= qos::kInfinite / 2;
    if (profile.owner != qos::Owner::kReader || !finite) continue;
    edits.push_back({profile.owner, profile.name, qos::Policy::kDeadline, 2 * deadline.number});
  }
  return qos::Edit(text, file, edits).bytes;
}

}  // namespace giveway::fleetctl
