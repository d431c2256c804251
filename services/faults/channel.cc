#include "services/faults/channel.h"

#include <algorithm>
#include <cstddef>
#include <map>
#include <optional>
#include <set>
#include <vector>

#include "services/faults/kind_table.h"

namespace giveway::faults {
namespace {

// Nothing is heard of `from` (kNoVehicle: of no other vehicle) in `times`.
struct Cut {
  VehicleId from = kNoVehicle;
  double from_s = 0;
  double to_s = 0;
  std::vector<Blackout> times;
};

double Value(const Fault& fault, Quantity quantity) {
  return *Get(Filled(fault.kind, fault.parameters), quantity);
}

bool Meets(const Fault& fault, VehicleId vehicle) {
  return fault.target.what == Target::What::kAll || fault.target.vehicle == vehicle;
}

// Off for the first half of each period.
std::vector<Blackout> TimesOf(const Fault& fault) {
  if (fault.kind != Kind::kFlapping) return {{fault.at_s, fault.EndsAt_s()}};
  const double period_s = Value(fault, Quantity::kPeriod);
  std::vector<Blackout> times;
  for (int i = 0; fault.at_s + i * period_s < fault.EndsAt_s(); ++i) {
    const double from_s = fault.at_s + i * period_s;
    times.push_back({from_s, std::min(from_s + period_s / 2, fault.EndsAt_s())});
  }
  return times;
}

// What the fault keeps `hearer` from hearing.
std::optional<Cut> CutOf(const Fault& fault, VehicleId hearer) {
  Cut cut{kNoVehicle, fault.at_s, fault.EndsAt_s(), {}};
  switch (fault.kind) {
    case Kind::kOneWayCut:
      if (!Meets(fault, hearer)) return std::nullopt;
      cut.from = fault.parameters.from.value_or(kNoVehicle);
      break;
    case Kind::kPartition:
    case Kind::kFlapping:
      if (!Meets(fault, hearer)) cut.from = fault.target.vehicle;
      break;
    default:
      return std::nullopt;
  }
  cut.times = TimesOf(fault);
  return cut;
}

// Adds what the fault asks of every vehicle's packets.
void Apply(const Fault& fault, ImpairmentRule* rule) {
  switch (fault.kind) {
    case Kind::kLoss:
      rule->loss = Value(fault, Quantity::kProbability);
      break;
    case Kind::kBurst:
      rule->burst = Value(fault, Quantity::kProbability);
      rule->burst_length = Value(fault, Quantity::kCount);
      break;
    case Kind::kDelay:
      rule->delay_s = Value(fault, Quantity::kDelay);
      break;
    case Kind::kReorder:
      rule->reorder = Value(fault, Quantity::kProbability);
      rule->reorder_by_s = Value(fault, Quantity::kDelay);
      break;
    case Kind::kDuplicate:
      rule->duplicate = Value(fault, Quantity::kProbability);
      break;
    case Kind::kCorrupt:
      rule->corrupt = Value(fault, Quantity::kProbability);
      break;
    case Kind::kRate:
      rule->rate_bytes_s = Value(fault, Quantity::kBytes);
      break;
    default:
      break;
  }
}

bool IsCut(Kind kind) {
  return kind == Kind::kOneWayCut || kind == Kind::kPartition || kind == Kind::kFlapping;
}

// Those of a list that are active, as time passes: each is looked at once when it starts and once
// when it ends, because a list of weeks has hundreds of thousands.
template <typename Lasting>
class Sweep {
 public:
  // `all` in order of their start; outlives this.
  explicit Sweep(const std::vector<Lasting>& all) : all_(all) {}

  // Those that last from `from_s` to `to_s`, which are no earlier than at the last call.
  const std::vector<const Lasting*>& Through(double from_s, double to_s) {
    for (; next_ < all_.size() && all_[next_].from_s <= from_s; ++next_) {
      active_.push_back(&all_[next_]);
    }
    std::erase_if(active_, [to_s](const Lasting* one) { return one->to_s < to_s; });
    return active_;
  }

 private:
  const std::vector<Lasting>& all_;
  std::size_t next_ = 0;
  std::vector<const Lasting*> active_;
};

// The hearer's rules. Between two moments at which something starts or ends one rule holds for all
// vehicles, and after it, since the last that fits counts, one for each that is cut off alone.
class Rules {
 public:
  Rules(const Schedule& schedule, VehicleId hearer) {
    for (const Fault& fault : schedule) {
      if (ActorOf(fault.kind) != Actor::kHearer) continue;
      if (const auto cut = CutOf(fault, hearer)) {
        cuts_.push_back(*cut);
      } else if (!IsCut(fault.kind) && Meets(fault, hearer)) {
        faults_.push_back({&fault, fault.at_s, fault.EndsAt_s()});
      }
    }
    std::ranges::stable_sort(faults_, {}, &Disturbance::from_s);
    std::ranges::stable_sort(cuts_, {}, &Cut::from_s);
  }

  std::vector<ImpairmentRule> Made() const {
    const std::vector<double> moments = Moments();
    Sweep faults(faults_);
    Sweep cuts(cuts_);
    std::vector<ImpairmentRule> rules;
    for (std::size_t i = 1; i < moments.size(); ++i) {
      const Span span{moments[i - 1], moments[i]};
      const auto& active = faults.Through(span.from_s, span.to_s);
      const auto& cut = cuts.Through(span.from_s, span.to_s);
      AddRules(span, active, cut, &rules);
    }
    return rules;
  }

 private:
  struct Disturbance {
    const Fault* fault;
    double from_s;
    double to_s;
  };
  // Between two neighbouring moments.
  struct Span {
    double from_s;
    double to_s;
  };

  std::vector<double> Moments() const {
    std::set<double> moments;
    for (const Disturbance& one : faults_) moments.insert({one.from_s, one.to_s});
    for (const Cut& cut : cuts_) moments.insert({cut.from_s, cut.to_s});
    return {moments.begin(), moments.end()};
  }

  static void Black(const Cut& cut, const Span& span, ImpairmentRule* rule) {
    for (const Blackout& time : cut.times) {
      const double from_s = std::max(time.from_s, span.from_s);
      const double to_s = std::min(time.to_s, span.to_s);
      if (from_s < to_s) rule->blackouts.push_back({from_s, to_s});
    }
  }

  static void AddRules(const Span& span, const std::vector<const Disturbance*>& faults,
                       const std::vector<const Cut*>& cuts, std::vector<ImpairmentRule>* rules) {
    ImpairmentRule all{.from = ImpairedSender::kVehicles};
    all.from_s = span.from_s;
    all.to_s = span.to_s;
    for (const Disturbance* one : faults) Apply(*one->fault, &all);
    bool any = !faults.empty();
    for (const Cut* cut : cuts) {
      if (cut->from != kNoVehicle) continue;
      any = true;
      Black(*cut, span, &all);
    }
    if (any) rules->push_back(all);
    std::map<VehicleId, ImpairmentRule> alone;
    for (const Cut* cut : cuts) {
      if (cut->from == kNoVehicle) continue;
      ImpairmentRule& rule = alone.try_emplace(cut->from, all).first->second;
      rule.from = ImpairedSender::kOneVehicle;
      rule.from_vehicle = cut->from;
      Black(*cut, span, &rule);
    }
    for (const auto& [from, rule] : alone) rules->push_back(rule);
  }

  std::vector<Disturbance> faults_;
  std::vector<Cut> cuts_;
};

}  // namespace

std::map<VehicleId, Impairment> ImpairmentOf(const Schedule& schedule,
                                             std::span<const VehicleId> vehicles) {
  std::map<VehicleId, Impairment> impairments;
  for (const VehicleId hearer : vehicles) {
    std::vector<ImpairmentRule> rules = Rules(schedule, hearer).Made();
    if (!rules.empty()) impairments[hearer].rules = std::move(rules);
  }
  return impairments;
}

std::map<VehicleId, Impairment> ImpairmentWith(const Schedule& schedule,
                                               std::span<const VehicleId> vehicles,
                                               const Impairment& always) {
  std::map<VehicleId, Impairment> heard;
  const auto by_faults = ImpairmentOf(schedule, vehicles);
  if (by_faults.empty()) return heard;
  for (const VehicleId vehicle : vehicles) heard[vehicle] = always;
  for (const auto& [vehicle, impairment] : by_faults) {
    std::vector<ImpairmentRule>& rules = heard[vehicle].rules;
    rules.insert(rules.end(), impairment.rules.begin(), impairment.rules.end());
  }
  return heard;
}

}  // namespace giveway::faults
