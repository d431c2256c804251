#include "services/fleetctl/virtual/virtual_flags.h"

#include <fmt/format.h>

#include <cmath>
#include <optional>
#include <regex>
#include <vector>

#include "services/config/flag_values.h"
#include "services/fleetctl/args/duration_flag.h"
#include "services/fleetctl/args/flag_checks.h"
#include "sim_world/virtual/invariants.h"

namespace giveway::fleetctl {
namespace {

// "LO..HI", or "N" for both.
std::optional<NumberRange> ParseRange(const std::string& text) {
  const std::size_t dots = text.find("..");
  const auto low = FiniteNumber(text.substr(0, dots));
  const auto high = dots == std::string::npos ? low : FiniteNumber(text.substr(dots + 2));
  if (!low || !high || *low > *high) return std::nullopt;
  return NumberRange{*low, *high};
}

NumberRange NumbersOf(const std::string& flag, const std::string& text, double least, double most) {
  const auto range = ParseRange(text);
  if (range && range->low >= least && range->high <= most) return *range;
  throw CLI::ValidationError(
      flag, fmt::format("{} to {}, a number or LO..HI, not '{}'", least, most, text));
}

// In percent: each number may have a percent sign.
std::string WithoutPercentSigns(std::string text) {
  const std::size_t dots = text.find("..");
  if (text.ends_with("%")) text.pop_back();
  if (dots != std::string::npos && dots > 0 && text[dots - 1] == '%') text.erase(dots - 1, 1);
  return text;
}

void AddRadioFlags(CLI::App* verb, CaseOptions* made_by) {
  verb->add_option_function<std::string>(
          "--loss",
          [made_by](const std::string& text) {
            made_by->loss_percent = NumbersOf("--loss", WithoutPercentSigns(text), 0, 99);
          },
          "Percent of beacons lost: 5%, or LO..HI%")
      ->type_name("PERCENT")
      ->default_str("0");
  verb->add_flag("--burst", made_by->burst, "The loss comes in bursts of five beacons on average");
  verb->add_option("--delay", made_by->delay_ms, "Transit time of a beacon in milliseconds")
      ->default_str("0")
      ->check(Between(0, 1000));
  verb->add_option("--jitter", made_by->jitter_ms,
                   "Maximum random extra transit time in milliseconds")
      ->default_str("0")
      ->check(Between(0, 1000));
  verb->add_option("--reorder", made_by->reorder_percent, "Percent held back and overtaken")
      ->default_str("0")
      ->check(Between(0, 100));
  verb->add_option("--duplicate", made_by->duplicate_percent, "Percent heard twice")
      ->default_str("0")
      ->check(Between(0, 100));
  verb->add_flag("--loopback", made_by->loops_back, "Every vehicle receives its own beacons too");
}

const std::vector<SonarTier> kMixedTiers = {SonarTier::kIdeal, SonarTier::kTypical,
                                            SonarTier::kP3dx};

std::vector<SonarTier> TiersOf(const std::string& tier) {
  if (tier == "mixed") return kMixedTiers;
  if (tier == "ideal") return {SonarTier::kIdeal};
  if (tier == "typical") return {SonarTier::kTypical};
  return {tier == "p3dx" ? SonarTier::kP3dx : SonarTier::kCrosstalk};
}

// A part of --fault. Later than the longest run it would never happen.
double SecondsOf(const std::string& name, const std::string& text) {
  constexpr double kLongestRun_s = 86400;
  const std::string wrong = WhyNotBetween(text, 0, kLongestRun_s);
  if (!wrong.empty()) throw CLI::ValidationError("--fault " + name, wrong);
  return *FiniteNumber(text);
}

// KIND:ID@AT+FOR, seconds: pause:3@12.5+0.4.
sim::ProcessFault FaultOf(const std::string& text) {
  static const std::regex kForm(R"((crash|pause|restart):(\d{1,9})@(\d+\.?\d*)(?:\+(\d+\.?\d*))?)");
  std::smatch part;
  if (!std::regex_match(text, part, kForm)) {
    throw CLI::ValidationError(
        "--fault", "must be KIND:ID@AT+FOR, as in pause:3@12.5+0.4, not '" + text + "'");
  }
  using Kind = sim::ProcessFaultKind;
  sim::ProcessFault fault;
  fault.kind = part[1] == "crash"   ? Kind::kCrash
               : part[1] == "pause" ? Kind::kPause
                                    : Kind::kRestart;
  fault.vehicle = VehicleId{static_cast<std::uint32_t>(std::stoul(part[2]))};
  fault.at_s = SecondsOf("AT", part[3]);
  if (part[4].matched) fault.for_s = SecondsOf("FOR", part[4]);
  return fault;
}

void AddCountFlag(CLI::App* verb, const std::string& flag, WholeRange* counts,
                  const std::string& description) {
  verb->add_option_function<std::string>(
      flag, [=](const std::string& text) { *counts = WholesOf(flag, text, 0, 1000); },
      description + ", or LO..HI");
}

// To be added before the other flags, which override what it sets.
void AddFleetFlag(CLI::App* verb, CaseOptions* made_by) {
  verb->add_option_function<std::string>(
          "--fleet",
          [made_by](const std::string& fleet) {
            if (fleet == "stock") return;
            // Wheels that differ lead a vehicle astray that has no sensor of its position.
            made_by->fleet = {.mixed_robots = true,
                              .tiers = kMixedTiers,
                              .most_slip = 0.02,
                              .most_wheel_error = 0.02,
                              .draws_pose_fix = true,
                              .pose_keeping_share = 0.5};
            made_by->loss_percent = {0, 20};
            made_by->crashes = {0, 1};
            made_by->pauses = {0, 2};
            made_by->restarts = {0, 1};
          },
          "stock, or mixed: short for --robots mixed --tier mixed --slip 0..2 --loss 0..20 "
          "--crashes 0..1 --pauses 0..2 --restarts 0..1, and in half of the seeds --wheel-error "
          "0..2 --pose-fix mixed; flags given in addition count")
      ->check(CLI::IsMember({"stock", "mixed"}));
}

void AddRobotFlags(CLI::App* verb, CaseOptions* made_by) {
  verb->add_option_function<std::string>(
          "--robots",
          [made_by](const std::string& robots) { made_by->fleet.mixed_robots = robots == "mixed"; },
          "stock: Pioneers at 0.2 to 0.6 m/s. mixed: each vehicle of a generator draws its body, "
          "acceleration, braking, turn rate and 0.2 to 1.0 m/s; what could not stop is drawn again")
      ->check(CLI::IsMember({"stock", "mixed"}));
  verb->add_option_function<std::string>(
          "--tier", [made_by](const std::string& tier) { made_by->fleet.tiers = TiersOf(tier); },
          "Of the ultrasonics: ideal, typical, p3dx, crosstalk, or mixed: each seed draws one of "
          "the first three; default the scenario's, of generators ideal")
      ->check(CLI::IsMember({"ideal", "typical", "p3dx", "crosstalk", "mixed"}));
  verb->add_option_function<std::string>(
      "--slip",
      [made_by](const std::string& text) {
        const NumberRange percent = NumbersOf("--slip", WithoutPercentSigns(text), 0, 50);
        made_by->fleet.least_slip = percent.low / 100;
        made_by->fleet.most_slip = percent.high / 100;
      },
      "Percent of wheel slip and of encoder noise, or LO..HI: each vehicle draws both");
}

// "EVERY_S,SIGMA_M,DROPOUT".
PoseFixModel PoseFixOf(const std::string& text) {
  static const std::regex kForm(R"(([\d.]+),([\d.]+),([\d.]+))");
  std::smatch part;
  if (!std::regex_match(text, part, kForm)) {
    throw CLI::ValidationError(
        "--pose-fix",
        "must be mixed, or EVERY_S,SIGMA_M,DROPOUT as in 1,0.05,0.1, not '" + text + "'");
  }
  const auto number = [](const std::string& name, const std::string& value, double least,
                         double most) {
    return NumbersOf("--pose-fix " + name, value, least, most).low;
  };
  return {.every_s = number("EVERY_S", part[1], 0.005, 3600),
          .sigma_m = number("SIGMA_M", part[2], 0.001, 10),
          .dropout = number("DROPOUT", part[3], 0, 0.99)};
}

void AddPoseFlags(CLI::App* verb, CaseOptions* made_by) {
  verb->add_option_function<std::string>(
      "--pose-fix",
      [made_by](const std::string& text) {
        FleetChoice& fleet = made_by->fleet;
        fleet.draws_pose_fix = text == "mixed";
        fleet.pose_keeping_share = 1;
        fleet.pose_fix = fleet.draws_pose_fix ? PoseFixModel{} : PoseFixOf(text);
      },
      "EVERY_S,SIGMA_M,DROPOUT: each vehicle has a sensor of its position, as in 1,0.05,0.1; "
      "mixed: "
      "each seed draws them, 0.2 to 2 s, 0.02 to 0.1 m, 0 to 0.3");
  verb->add_option_function<std::string>(
      "--wheel-error",
      [made_by](const std::string& text) {
        const NumberRange percent = NumbersOf("--wheel-error", text, 0, 20);
        made_by->fleet.pose_keeping_share = 1;
        made_by->fleet.least_wheel_error = percent.low / 100;
        made_by->fleet.most_wheel_error = percent.high / 100;
      },
      "Percent by which the wheel diameters differ and the axle length is wrong, or LO..HI: each "
      "vehicle draws both, and their signs");
  verb->add_option_function<std::string>(
      "--pose-limit",
      [made_by](const std::string& text) {
        made_by->fleet.pose_limit_m = NumbersOf("--pose-limit", text, 0, 10).low;
      },
      "Metres of standard deviation beyond which a vehicle says that it is lost, 0: never; default "
      "0.3 with --pose-fix or --wheel-error, else the scenario's");
}

void AddJudgeFlag(CLI::App* verb, CaseOptions* made_by) {
  verb->add_option_function<std::vector<std::string>>(
          "--judge",
          [made_by](const std::vector<std::string>& names) {
            for (const std::string& name : names) {
              for (std::uint32_t i = 0; i < sim::kInvariantCount; ++i) {
                const bool meant = name == "all" || name == Name(static_cast<sim::Invariant>(i));
                if (meant) made_by->also_required |= 1U << i;
              }
            }
          },
          "Invariants that are else only counted fail a run too: clearance, claim, delay, "
          "yielding, or all")
      ->delimiter(',')
      ->check(CLI::IsMember({"clearance", "claim", "delay", "yielding", "all"}));
}

void AddFaultFlags(CLI::App* verb, CaseOptions* made_by) {
  AddCountFlag(verb, "--crashes", &made_by->crashes, "Vehicles that die in each run");
  AddCountFlag(verb, "--pauses", &made_by->pauses, "Processes that stand still for a while");
  AddCountFlag(verb, "--restarts", &made_by->restarts, "Processes that restart");
  verb->add_option_function<std::vector<std::string>>(
      "--fault",
      [made_by](const std::vector<std::string>& texts) {
        for (const std::string& text : texts) made_by->faults.push_back(FaultOf(text));
      },
      "crash, pause or restart of one vehicle: KIND:ID@AT+FOR, seconds, as in pause:3@12.5+0.4. "
      "FOR is 0.5 if left out; from 1 s on the world takes it for dead. May be repeated");
  verb->add_option("--faults", made_by->fault_file,
                   "A fault file, or a shipped one: its faults by the seed, besides those of the "
                   "scenario, see fleetctl faults");
  verb->add_flag("--skip-unsupported", made_by->skip_unsupported,
                 "Leaves out of faults what a virtual run cannot do, and says so");
}

}  // namespace

WholeRange WholesOf(const std::string& flag, const std::string& text, double least, double most) {
  const NumberRange range = NumbersOf(flag, text, least, most);
  const bool whole = range.low == std::floor(range.low) && range.high == std::floor(range.high);
  if (!whole) throw CLI::ValidationError(flag, "must be whole, not '" + text + "'");
  return {static_cast<std::uint32_t>(range.low), static_cast<std::uint32_t>(range.high)};
}

void AddCaseFlags(CLI::App* verb, CaseOptions* made_by) {
  verb->add_option("SCENARIO", made_by->scenario, "A scenario file, a shipped one, or a generator")
      ->required();
  AddFleetFlag(verb, made_by);
  verb->add_option_function<std::string>(
      "--vehicles",
      [made_by](const std::string& text) {
        made_by->vehicles = WholesOf("--vehicles", text, 2, 1000);
      },
      "Of a generator, 2 to 1000, default 6; or of a scenario with spawn places, default its "
      "start_with; or LO..HI");
  verb->add_option_function<std::string>(
      "--behaviour",
      [made_by](const std::string& name) { made_by->behaviour = ParseBehaviour(name); },
      "Every vehicle drives so: cooperative, lecture_avoid, stock_avoid, lecture_yield, or "
      "lecture_printed, which shows the flaws of the printed scripts: it collides");
  AddTimeFlag(verb, "--duration", &made_by->duration_s,
              "Of a scenario: end after this time instead, 1s to 24h; without it one that lasts "
              "until it is stopped is run for 600s")
      ->check([](const std::string& text) {
        const double duration_s = ParseDuration_s(text).value_or(0);
        return duration_s >= 1 && duration_s <= 86400 ? std::string()
                                                      : "must be a time from 1s to 24h";
      });
  AddRobotFlags(verb, made_by);
  AddPoseFlags(verb, made_by);
  verb->add_option("--radio-seed", made_by->radio_seed, "Of the radio's draws; default the seed");
  verb->add_option("--sensor-seed", made_by->sensor_seed,
                   "Of what wheels and sensors draw; default the seed");
  AddRadioFlags(verb, made_by);
  AddFaultFlags(verb, made_by);
  AddJudgeFlag(verb, made_by);
  verb->add_option("--through", made_by->through_m,
                   "Of a file, as shrink prints it: how many metres of its place let only one "
                   "through at a time. Then vehicles are due as a generator's are (delay), and of "
                   "those that share a goal one must arrive")
      ->check(Between(0, 1000));
}

}  // namespace giveway::fleetctl
