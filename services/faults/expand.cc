#include "services/faults/expand.h"

#include <algorithm>
#include <set>
#include <string_view>
#include <tuple>
#include <utility>

#include "services/faults/channel.h"
#include "services/faults/exclusion.h"
#include "services/faults/kind_table.h"
#include "services/faults/schedule_text.h"
#include "services/types/math/math.h"
#include "services/types/math/random.h"

namespace giveway::faults {
namespace {

constexpr std::size_t kMostRefused = 100;  // pairs that exclude each other: a list has many

// Thousandths: what a list shows, and what it is read back as.
double ToMilliseconds(double time_s) {
  return static_cast<double>(static_cast<std::int64_t>(time_s * 1000 + 0.5)) / 1000;
}

// FNV-1a, 64 bits.
std::uint64_t HashOf(std::string_view name) {
  std::uint64_t hash = 0xcbf29ce484222325ULL;
  for (const char c : name) {
    hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3ULL;
  }
  return hash;
}

bool ByTime(const Fault& a, const Fault& b) {
  return std::tie(a.at_s, a.rule, a.nth) < std::tie(b.at_s, b.rule, b.nth);
}

// A fault before it is known whether it stays.
struct Drawn {
  Fault fault;
  int line = 0;
  bool random = false;
  std::size_t rule = 0;  // index in the file
};

// Which of two that exclude each other stays: planned before drawn, kill before others (it ends
// what follows), earlier before later.
bool Stays(const Drawn& a, const Drawn& b) {
  const auto rank = [](const Drawn& drawn) {
    return std::make_pair(drawn.random, drawn.fault.kind != Kind::kKill);
  };
  const auto of_a = rank(a);
  const auto of_b = rank(b);
  return of_a != of_b ? of_a < of_b : ByTime(a.fault, b.fault);
}

class Expander {
 public:
  Expander(const FaultFile& file, const Course& course, std::span<const VehicleId> vehicles)
      : file_(file), course_(course), vehicles_(vehicles.begin(), vehicles.end()) {
    std::sort(vehicles_.begin(), vehicles_.end());
    for (const RandomRule& rule : file.random) left_out_.push_back({rule.name});
  }

  Expansion Run() {
    for (const AtRule& rule : file_.at) Plan(rule);
    for (std::size_t i = 0; i < file_.random.size(); ++i) Draw(i);
    std::sort(drawn_.begin(), drawn_.end(),
              [](const Drawn& a, const Drawn& b) { return ByTime(a.fault, b.fault); });
    LeaveOutExcluded();
    std::erase_if(left_out_,
                  [](const LeftOut& left) { return left.excluded + left.too_late == 0; });
    expansion_.left_out = std::move(left_out_);
    return std::move(expansion_);
  }

 private:
  double HealingFrom_s() const { return course_.duration_s - course_.healing_s; }
  bool Exists(VehicleId id) const {
    return std::binary_search(vehicles_.begin(), vehicles_.end(), id);
  }
  std::string Fleet() const {
    if (vehicles_.empty()) return "the fleet has no vehicles";
    return "the fleet has " + std::to_string(vehicles_.size()) + " vehicles, " +
           std::to_string(Number(vehicles_.front())) + " to " +
           std::to_string(Number(vehicles_.back()));
  }

  template <typename Rule>
  void Refuse(const Rule& rule, std::string field, std::string message, std::string remedy) {
    expansion_.refused.push_back(
        {rule.name, rule.line, std::move(field), std::move(message), std::move(remedy)});
  }
  template <typename Rule>
  void RefuseUnlessThere(const Rule& rule, const char* field, VehicleId id) {
    if (Exists(id)) return;
    Refuse(rule, field, "there is no vehicle " + std::to_string(Number(id)) + ": " + Fleet(),
           "name one that is there, or more vehicles");
  }
  template <typename Rule>
  void RefuseFromItself(const Rule& rule, VehicleId target) {
    if (rule.parameters.from != target) return;
    Refuse(rule, "from", "vehicle " + std::to_string(Number(target)) + " does not hear itself",
           "name another vehicle than the target");
  }
  // What the ranges of one rule cannot show.
  template <typename Rule>
  void CheckParameters(const Rule& rule, double longest_s) {
    if (rule.parameters.from) RefuseUnlessThere(rule, "from", *rule.parameters.from);
    if (rule.kind != Kind::kFlapping) return;
    const double period_s = *Filled(rule.kind, rule.parameters).period_s;
    if (longest_s <= kMostFlaps * period_s) return;
    Refuse(rule, "for_s",
           "it would flap more than " + NumberText(kMostFlaps) + " times in " +
               SecondsText(longest_s) + " s",
           "shorten it, or raise period_s");
  }

  void Plan(const AtRule& rule) {
    if (rule.target.what == Target::What::kVehicle) {
      RefuseUnlessThere(rule, "vehicle", rule.target.vehicle);
      RefuseFromItself(rule, rule.target.vehicle);
    }
    CheckParameters(rule, rule.for_s);
    const Fault fault{rule.name,
                      rule.nth,
                      rule.time_s,
                      rule.for_s,
                      rule.kind,
                      rule.target,
                      Filled(rule.kind, rule.parameters)};
    if (fault.EndsAt_s() > HealingFrom_s()) {
      Refuse(rule, "time_s",
             "the fault ends " + SecondsText(fault.EndsAt_s()) + " s after the start; a run of " +
                 SecondsText(course_.duration_s) + " s heals from " + SecondsText(HealingFrom_s()) +
                 " s on",
             "start it earlier, or let the run last longer");
    }
    drawn_.push_back({fault, rule.line, false, 0});
  }

  // All vehicles but one.
  std::vector<VehicleId> Without(VehicleId left_out) const {
    std::vector<VehicleId> others = vehicles_;
    std::erase(others, left_out);
    return others;
  }

  std::vector<Target> TargetsAt(const RandomRule& rule, Random* dice) const {
    const auto one_of = [&](const std::vector<VehicleId>& ids) -> std::vector<Target> {
      const double place = dice->Uniform(0, 1) * static_cast<double>(ids.size());
      if (ids.empty()) return {};
      return {{Target::What::kVehicle, ids[static_cast<std::size_t>(place)]}};
    };
    std::vector<Target> every;
    switch (rule.targets.what) {
      case Targets::What::kAnyVehicle:
        return one_of(rule.parameters.from ? Without(*rule.parameters.from) : vehicles_);
      case Targets::What::kNamed:
        return one_of(rule.targets.named);
      case Targets::What::kEveryVehicle:
        for (const VehicleId id : vehicles_) {
          if (id != rule.parameters.from) every.push_back({Target::What::kVehicle, id});
        }
        return every;
      case Targets::What::kWorld:
        return {{Target::What::kWorld}};
      case Targets::What::kDiscoveryServer:
        return {{Target::What::kDiscoveryServer}};
      case Targets::What::kAll:
        return {{Target::What::kAll}};
    }
    return every;
  }

  void CheckTargets(const RandomRule& rule) {
    CheckParameters(rule, rule.for_high_s);
    for (const VehicleId id : rule.targets.named) {
      RefuseUnlessThere(rule, "vehicle", id);
      RefuseFromItself(rule, id);
    }
    const bool needs_fleet = rule.targets.what == Targets::What::kAnyVehicle ||
                             rule.targets.what == Targets::What::kEveryVehicle;
    if (needs_fleet && vehicles_.empty()) Refuse(rule, "target", Fleet(), "name more vehicles");
  }

  void Draw(std::size_t index) {
    const RandomRule& rule = file_.random[index];
    CheckTargets(rule);
    if (!expansion_.refused.empty()) return;
    const std::uint64_t of_rule = Random(course_.seed, HashOf(rule.name)).Next();
    const Parameters parameters = Filled(rule.kind, rule.parameters);
    double at_s = course_.warm_up_s;
    std::uint32_t nth = 0;
    for (std::uint32_t count = 0; count < rule.at_most.value_or(UINT32_MAX); ++count) {
      Random dice(of_rule, count);
      at_s -= rule.mean_between_s * Log(1 - dice.Uniform(0, 1));
      if (!(at_s < HealingFrom_s())) return;
      const double for_s = ToMilliseconds(dice.Uniform(rule.for_low_s, rule.for_high_s));
      for (const Target& target : TargetsAt(rule, &dice)) {
        Add(index, {rule.name, nth++, ToMilliseconds(at_s), for_s, rule.kind, target, parameters});
      }
      if (drawn_.size() > kMostFaults) {
        return Refuse(rule, "mean_between_s",
                      "makes more than " + std::to_string(kMostFaults) + " faults in all",
                      "raise it, or set at_most");
      }
    }
  }

  void Add(std::size_t rule, Fault fault) {
    if (fault.EndsAt_s() > HealingFrom_s()) {
      ++left_out_[rule].too_late;
    } else {
      drawn_.push_back({std::move(fault), file_.random[rule].line, true, rule});
    }
  }

  void RefuseBoth(const Drawn& a, const Drawn& b) {
    if (++excluding_ > kMostRefused) return;
    const auto described = [](const Drawn& drawn) {
      return drawn.fault.rule + " (" + Line(drawn.fault) + ")" +
             (drawn.line > 0 ? " of line " + std::to_string(drawn.line) : "");
    };
    expansion_.refused.push_back(
        {b.fault.rule, b.line, "",
         described(b) + " and " + described(a) + " exclude each other: they overlap on one target",
         "move one of them, or leave it out", a.fault.rule});
  }

  void LeaveOutExcluded() {
    std::vector<Fault> faults;
    for (const Drawn& drawn : drawn_) faults.push_back(drawn.fault);
    std::vector<bool> out(faults.size());
    ForEachExcluding(faults, [&](std::size_t i, std::size_t j) {
      if (!drawn_[i].random && !drawn_[j].random) return RefuseBoth(drawn_[i], drawn_[j]);
      out[Stays(drawn_[i], drawn_[j]) ? j : i] = true;
    });
    if (excluding_ > kMostRefused) {
      expansion_.refused.back().message +=
          "; and " + std::to_string(excluding_ - kMostRefused) + " more pairs do";
    }
    for (std::size_t i = 0; i < faults.size(); ++i) {
      if (out[i]) {
        ++left_out_[drawn_[i].rule].excluded;
      } else {
        expansion_.schedule.push_back(std::move(faults[i]));
      }
    }
  }

  const FaultFile& file_;
  const Course& course_;
  std::vector<VehicleId> vehicles_;  // sorted
  std::vector<Drawn> drawn_;
  std::vector<LeftOut> left_out_;  // of each random rule
  std::size_t excluding_ = 0;      // pairs of planned faults
  Expansion expansion_;
};

}  // namespace

Course CourseOfRun(const FaultFile& file, double duration_s, std::uint32_t seed) {
  Course course{.seed = seed, .duration_s = duration_s};
  if (!file.random.empty()) return course;
  course.healing_s = 0;
  for (const AtRule& rule : file.at) {
    course.duration_s = std::max(course.duration_s, rule.time_s + rule.for_s);
  }
  return course;
}

Expansion Expand(const FaultFile& file, const Course& course, std::span<const VehicleId> vehicles) {
  return Expander(file, course, vehicles).Run();
}

FaultFile AsFile(const Schedule& schedule) {
  FaultFile file;
  for (const Fault& fault : schedule) {
    file.at.push_back({fault.rule, fault.nth, fault.at_s, fault.for_s, fault.kind, fault.target,
                       fault.parameters});
  }
  return file;
}

}  // namespace giveway::faults
