#include "services/fleetctl/virtual/shrink.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>

#include "services/config/writing/scenario_write.h"
#include "services/faults/schedule_text.h"
#include "services/fleetctl/output/output_file.h"
#include "services/fleetctl/process/exit_codes.h"
#include "services/fleetctl/process/interrupts.h"
#include "services/fleetctl/virtual/shrinker.h"

namespace giveway::fleetctl {
namespace {

std::string_view Word(sim::ProcessFaultKind kind) {
  if (kind == sim::ProcessFaultKind::kCrash) return "crash";
  return kind == sim::ProcessFaultKind::kPause ? "pause" : "restart";
}

bool ShowProgress(const VirtualCase& smallest, std::uint32_t attempts) {
  if (::isatty(STDERR_FILENO) == 1) {
    fmt::print(stderr, "\r{} tries, {} vehicles, {:.0f} s \x1b[K", attempts,
               smallest.scenario.vehicles.size(), smallest.scenario.duration_s);
    std::fflush(stderr);
  }
  return Interrupts::Count() == 0;
}

// What is else only counted, and is required here.
std::string JudgeFlag(const sim::VirtualPlan& plan) {
  const sim::InvariantSet judged =
      sim::InvariantSet(plan.also_required) & ~sim::RequiredInvariants();
  std::string flag;
  for (std::size_t i = 0; i < sim::kInvariantCount; ++i) {
    if (!judged.test(i)) continue;
    flag += flag.empty() ? " --judge " : ",";
    flag += sim::Name(static_cast<sim::Invariant>(i));
  }
  return flag;
}

// The name NAME.faults.textproto for NAME.textproto.
std::string FaultFileOf(const std::string& file) {
  constexpr std::string_view kEnding = ".textproto";
  const std::string name =
      file.ends_with(kEnding) ? file.substr(0, file.size() - kEnding.size()) : file;
  return name + ".faults" + std::string(kEnding);
}

std::string Comment(const CaseMaker& maker, const ShrinkOptions& options, const Shrunk& shrunk,
                    const std::string& file) {
  return fmt::format(
      "Left of {} with seed {} after {} tries: breaks {} at tick {}.\nReplay:\n"
      "  fleetctl virtual {} --seed 0{}\n",
      maker.Name(), options.seed, shrunk.attempts, sim::Name(shrunk.violation.invariant),
      Number(shrunk.violation.tick), file, ReplayFlags(shrunk.made, FaultFileOf(file)));
}

// An expectation names vehicles: a smaller run that also misses it would show nothing.
int ReportNothingBreaks(const CaseMaker& maker, const ShrinkOptions& options,
                        const VirtualCase& made) {
  const std::string which(options.invariant ? sim::Name(*options.invariant) : "no invariant");
  fmt::print("{} with seed {} {} {}\n", maker.Name(), options.seed,
             options.invariant ? "does not break" : "breaks", which);
  if (options.invariant || !maker.HasExpectations()) return 0;
  const std::string unmet = sim::RunVirtually(made.scenario, made.plan).unmet;
  if (unmet.empty()) return 0;
  fmt::print(stderr, "it misses what it expects, which is not shrunk: {}\n", unmet);
  return kCouldNotRun;
}

}  // namespace

std::string ReplayFlags(const VirtualCase& made, const std::string& fault_file) {
  const sim::VirtualPlan& plan = made.plan;
  const sim::RadioSettings& radio = plan.radio;
  std::string flags;
  const auto add = [&](const char* flag, double value) {
    if (value > 0) flags += fmt::format(" {} {}", flag, value);
  };
  if (radio.burst.enter > 0) {
    // The share of bad links is the requested loss.
    add("--loss", 100 * radio.burst.enter / (radio.burst.enter + radio.burst.leave));
    flags += " --burst";
  } else {
    add("--loss", 100 * radio.loss);
  }
  add("--delay", Milliseconds(radio.delay));
  add("--jitter", Milliseconds(radio.jitter));
  add("--reorder", 100 * radio.reorder);
  add("--duplicate", 100 * radio.duplicate);
  if (radio.loops_back) flags += " --loopback";
  if (!plan.schedule.empty()) flags += " --faults " + fault_file;
  if (!flags.empty()) flags += fmt::format(" --radio-seed {}", plan.seed);
  if (made.scenario.seed != 0) flags += fmt::format(" --sensor-seed {}", made.scenario.seed);
  for (const sim::ProcessFault& fault : plan.faults) {
    flags += fmt::format(" --fault {}:{}@{}", Word(fault.kind), Number(fault.vehicle), fault.at_s);
    if (fault.kind != sim::ProcessFaultKind::kCrash) flags += fmt::format("+{}", fault.for_s);
  }
  if (plan.through_m) flags += fmt::format(" --through {}", *plan.through_m);
  return flags + JudgeFlag(plan);
}

int RunShrink(const ShrinkOptions& options) {
  const CaseMaker maker(options.made_by);
  const std::string file = options.out_file.empty()
                               ? fmt::format("{}_{}.textproto", maker.Name(), options.seed)
                               : options.out_file;
  std::fputs(maker.Remark().c_str(), stderr);
  CheckWritable(file);
  if (maker.HasFaults()) CheckWritable(FaultFileOf(file));
  VirtualCase failing = maker.Make(options.seed);
  ReadBack(failing.scenario);  // throws now rather than after a minute's work
  const Interrupts interrupts(Silence::kComputes);
  std::optional<Shrunk> shrunk = Shrink(failing, ShowProgress, options.invariant);
  if (::isatty(STDERR_FILENO) == 1) std::fputs("\r\x1b[K", stderr);
  if (!shrunk) return ReportNothingBreaks(maker, options, failing);
  Scenario& scenario = shrunk->made.scenario;
  scenario.name = fmt::format("{}_{}", maker.Name(), options.seed);
  WriteFile(file, WriteScenario(scenario, Comment(maker, options, *shrunk, file)));
  if (!shrunk->as_file) {
    fmt::print(stderr, "{}: read back it need not break that: last digits of angles differ\n",
               file);
  }
  const faults::Schedule& schedule = shrunk->made.plan.schedule;
  if (!schedule.empty()) WriteFile(FaultFileOf(file), faults::AsTextproto(schedule));
  fmt::print("{}: {} of {} vehicles, {} of {} scheduled faults, {:.0f} s, breaks {}\n", file,
             scenario.vehicles.size(), failing.scenario.vehicles.size(), schedule.size(),
             failing.plan.schedule.size(), scenario.duration_s,
             sim::Name(shrunk->violation.invariant));
  fmt::print("fleetctl virtual {} --seed 0{}\n", file,
             ReplayFlags(shrunk->made, FaultFileOf(file)));
  return 1;
}

}  // namespace giveway::fleetctl
