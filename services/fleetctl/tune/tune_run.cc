#include "services/fleetctl/tune/tune_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <span>
#include <thread>
#include <utility>

#include "services/config/impair.h"
#include "services/config/problem.h"
#include "services/config/scenario_file.h"
#include "services/fleetctl/args/qos_files.h"
#include "services/fleetctl/output/output_file.h"
#include "services/fleetctl/output/terminal_text.h"
#include "services/fleetctl/process/child_process.h"
#include "services/fleetctl/process/exit_codes.h"
#include "services/fleetctl/process/interrupts.h"
#include "services/fleetctl/process/program_id.h"
#include "services/fleetctl/tune/tune_draw.h"
#include "services/fleetctl/tune/tune_front.h"
#include "services/fleetctl/tune/tune_report.h"
#include "services/fleetctl/tune/tune_search.h"
#include "services/link/convert/crc32c.h"
#include "services/link/fastdds/library_release.h"
#include "services/qos/profile_check.h"
#include "services/runtime/json.h"

namespace giveway::fleetctl {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void Refuse(const std::string& file, const std::string& what,
                         const std::string& remedy) {
  throw InputError({{file, 0, "", "", what, remedy}});
}

// Resolves the defaults of the flags.
QosTuneOptions Filled(QosTuneOptions options) {
  if (options.trial_s <= 0) options.trial_s = options.quick ? 12 : 20;
  if (options.verify_trials == 0) options.verify_trials = options.quick ? 5 : 6;
  if (options.fleets == 0) options.fleets = 2 * std::max(1U, std::thread::hardware_concurrency());
  // An unimpaired vehicle counts no packets: this impairs nothing, but counts.
  if (options.impair == "none" || options.impair.empty()) options.impair = "loss=0";
  return options;
}

Json ProgramsJson() {
  Json programs;
  for (const char* const service : {"giveway-world", "giveway-vehicle"}) {
    programs[service] = ProgramIdOf(ProgramFolder() / service);
  }
  return programs;
}

// Everything that the evidence depends on; the number of parallel fleets may change.
std::string PlanOf(const QosTuneOptions& options, const qos::ProfileFile& base) {
  const std::span bytes(reinterpret_cast<const std::uint8_t*>(base.bytes.data()),
                        base.bytes.size());
  Json plan;
  plan["programs"] = ProgramsJson();
  plan["library"] = std::string(link::LibraryName());
  plan["base"] = base.name;
  plan["base_crc"] = link::Crc32c(bytes);
  plan["impair"] = options.impair;
  plan["vehicles"] = options.vehicles;
  plan["seed"] = options.seed;
  plan["quick"] = options.quick;
  plan["trial_s"] = options.trial_s;
  plan["candidates"] = options.candidates;
  plan["verify_trials"] = options.verify_trials;
  return JsonText(std::move(plan));
}

class Tuning {
 public:
  explicit Tuning(const QosTuneOptions& options)
      : options_(Filled(options)), base_(ReadBase()), store_(options_.out, Plan()) {
    store_.Write("scenario.textproto", TuneScenarioText(options_.vehicles));
    const std::string scenario_file = (store_.Folder() / "scenario.textproto").string();
    scenario_ = LoadScenario(scenario_file, {});
    ground_ = {.fleet = {.program_folder = ProgramFolder(),
                         .scenario_file = scenario_file,
                         .flags_only = true},
               .scenario = &scenario_,
               .observer_qos = base_.name,
               .alive_s = options_.trial_s};
    ground_.fleet.options.impair = options_.impair;
    ground_.fleet.options.vehicles = 0;  // only those the scenario names
    MakeProfiles();
  }

  TuneResult Run();
  const TuneStore& Store() const { return store_; }
  std::string ProfileOf(const std::string& candidate) const { return profiles_.at(candidate); }

 private:
  std::string Plan() const { return PlanOf(options_, base_); }
  qos::ProfileFile ReadBase();
  void MakeProfiles();
  std::string CheckedProfile(const TuneCandidate& candidate, std::string* trouble) const;
  std::size_t PlannedTrials(const std::vector<Rung>& rungs) const;
  void Climb(const std::vector<Rung>& rungs, TuneSearch* search);
  void TakeFigures(const TuneSearch& search, std::uint32_t most);
  void Verify(TuneSearch* search);

  QosTuneOptions options_;
  qos::ProfileFile base_;
  TuneStore store_;
  Scenario scenario_;
  TuneGround ground_;
  TuneResult result_;
  std::map<std::string, std::string> profiles_;  // by candidate: the file's text
};

qos::ProfileFile Tuning::ReadBase() {
  const std::string path = ResolveQosFile(options_.base);
  auto read = ReadQosFile(path);
  if (const auto* why = std::get_if<qos::Finding>(&read)) {
    Refuse(path, why->values, why->remedy);
  }
  qos::ProfileFile base = std::move(std::get<qos::ProfileFile>(read));
  const qos::Findings findings = qos::Check({base}, {.vehicles = options_.vehicles});
  if (qos::ExitCode(findings) >= 2) {
    const auto error = std::ranges::find(findings, qos::Severity::kError, &qos::Finding::severity);
    Refuse(path, error->values + ": " + error->consequence,
           "fleetctl qos check " + path + " says all that is wrong; correct it first");
  }
  const std::string why =
      WhyNotTunable(qos::ReadProfiles(*qos::ReadXml(base.bytes, path).root, path));
  if (!why.empty()) Refuse(path, why, "start from a copy of config/qos/default.xml");
  return base;
}

// The base's text with the candidate's values; empty, with a message in `trouble`, if `qos check`
// finds an error in it.
std::string Tuning::CheckedProfile(const TuneCandidate& candidate, std::string* trouble) const {
  const BeaconQos& base = result_.candidates.front().candidate.qos;
  const qos::EditedProfiles edited =
      qos::Edit(base_.bytes, base_.name, EditsOf(candidate.qos, base));
  qos::Findings findings = edited.findings;
  if (findings.empty()) {
    const qos::Deployment deployment{.vehicles = options_.vehicles,
                                     .tick_ns = scenario_.tick_period.count()};
    findings = qos::Check({{candidate.name + ".xml", edited.bytes}}, deployment);
  }
  const auto error = std::ranges::find(findings, qos::Severity::kError, &qos::Finding::severity);
  if (error == findings.end()) return edited.bytes;
  *trouble = "refused by qos check: " + error->rule + ": " + error->values;
  return {};
}

void Tuning::MakeProfiles() {
  const auto set = qos::ReadProfiles(*qos::ReadXml(base_.bytes, base_.name).root, base_.name);
  const TunePlanOptions plan{scenario_.tick_period, options_.quick, options_.candidates};
  result_.base_file = base_.name;
  result_.impair = options_.impair;
  const VehicleOptions& vehicle = scenario_.vehicles.front();
  result_.fleet = {options_.vehicles, Milliseconds(scenario_.tick_period),
                   Milliseconds(vehicle.beacon_age_limit)};
  result_.seed = options_.seed;
  result_.alive_s = options_.trial_s;
  const auto channel = ChannelOf(ParseImpairment(options_.impair).impairment);
  for (TuneCandidate& candidate : MakeCandidates(BeaconQosOf(set), plan)) {
    result_.candidates.push_back({.candidate = std::move(candidate)});
    TunedCandidate& tuned = result_.candidates.back();
    const std::string text = CheckedProfile(tuned.candidate, &tuned.trouble);
    if (channel) tuned.predicted = Predict(tuned.candidate.qos, *channel, result_.fleet);
    if (!tuned.trouble.empty()) continue;
    profiles_[tuned.candidate.name] = text;
    store_.Write("profiles/" + tuned.candidate.name + ".xml", text);
  }
}

std::size_t Tuning::PlannedTrials(const std::vector<Rung>& rungs) const {
  std::size_t trials = std::size_t{2} * options_.verify_trials;
  std::uint32_t before = 0;
  for (const Rung& rung : rungs) {
    trials += std::size_t{rung.candidates} * (rung.trials - before);
    before = rung.trials;
  }
  return trials;
}

// Of the first `most` trials: a resumed search sees what it saw before it was interrupted.
void Tuning::TakeFigures(const TuneSearch& search, std::uint32_t most) {
  std::vector<std::vector<TrialEvidence>> taken;
  for (const TunedCandidate& tuned : result_.candidates) {
    taken.push_back(search.TrialsOf(tuned.candidate.name, false));
    if (taken.back().size() > most) taken.back().resize(most);
  }
  const double dispersion = Dispersion(taken);
  for (std::size_t i = 0; i < taken.size(); ++i) {
    TunedCandidate& tuned = result_.candidates[i];
    const std::vector<TrialEvidence>& trials = taken[i];
    tuned.figures = FiguresOf(trials, dispersion);
    if (!tuned.figures && !trials.empty()) tuned.trouble = trials.front().trouble;
    if (tuned.figures && tuned.predicted) {
      tuned.disagreement = Disagreement(*tuned.figures, *tuned.predicted);
    }
  }
}

// Rung by rung the better half gets more time; the base always does.
void Tuning::Climb(const std::vector<Rung>& rungs, TuneSearch* search) {
  std::vector<std::size_t> left;
  for (std::size_t i = 0; i < result_.candidates.size(); ++i) {
    if (result_.candidates[i].trouble.empty()) left.push_back(i);
  }
  for (const Rung& rung : rungs) {
    if (left.size() > rung.candidates) left.resize(rung.candidates);
    if (std::ranges::find(left, std::size_t{0}) == left.end()) left.back() = 0;
    std::vector<TuneCandidate> candidates;
    for (const std::size_t place : left) {
      candidates.push_back(result_.candidates[place].candidate);
    }
    search->Measure(candidates, false, rung.trials);
    TakeFigures(*search, rung.trials);
    const TunedCandidate& base = result_.candidates.front();
    if (!base.figures) throw StartError("the base cannot be measured: " + base.trouble);
    std::erase_if(left, [&](std::size_t place) { return !result_.candidates[place].figures; });
    std::vector<TuneFigures> figures;
    for (const std::size_t place : left) figures.push_back(*result_.candidates[place].figures);
    std::vector<std::size_t> ranked;
    for (const std::size_t i : Ranking(figures)) ranked.push_back(left[i]);
    left = std::move(ranked);
  }
}

void Tuning::Verify(TuneSearch* search) {
  if (result_.recommended == 0) return;
  const TuneCandidate& base = result_.candidates.front().candidate;
  const TuneCandidate& chosen = result_.candidates[result_.recommended].candidate;
  search->Measure({base, chosen}, true, options_.verify_trials);
  const auto base_trials = search->TrialsOf(base.name, true);
  const auto chosen_trials = search->TrialsOf(chosen.name, true);
  const double dispersion = Dispersion({base_trials, chosen_trials});
  const auto of_base = FiguresOf(base_trials, dispersion);
  const auto of_chosen = FiguresOf(chosen_trials, dispersion);
  if (!of_base || !of_chosen) return;
  result_.verified = Verification{*of_base, *of_chosen, HasFewerAlarms(*of_chosen, *of_base),
                                  NoticesNoLater(*of_chosen, *of_base)};
}

TuneResult Tuning::Run() {
  const std::vector<Rung> rungs = MakeRungs(profiles_.size(), options_.quick);
  const Interrupts interrupts;
  TuneSearch search(ground_, store_, options_.fleets, options_.seed, PlannedTrials(rungs));
  const std::size_t before = search.All().size();
  if (before > 0) std::fprintf(stderr, "resuming: %zu trials are already done\n", before);
  Climb(rungs, &search);
  ChooseRecommended(&result_);
  Verify(&search);
  result_.trials = search.All();
  std::error_code ignored;
  fs::remove(store_.Folder() / "running", ignored);
  if (search.Measured() == 0) {
    std::fprintf(stderr, "nothing left to measure: all %zu trials are there\n", before);
  }
  return result_;
}

// Adds the choice of `fleetctl qos tune` at the top of the file.
std::string Headed(const std::string& profile, const TuneResult& result) {
  const TunedCandidate& chosen = result.candidates[result.recommended];
  return qos::WithComment(
      profile,
      fmt::format("fleetctl qos tune: {} vehicles, {}: fleet/beacon with {}.\n"
                  "     From {}; where a comment below says otherwise of fleet/beacon, this holds.",
                  result.fleet.vehicles, result.impair, QosText(chosen.candidate.qos),
                  result.base_file));
}

}  // namespace

int RunQosTune(const QosTuneOptions& options) {
  try {
    Tuning tuning(options);
    const TuneResult result = tuning.Run();
    const TuneStore& store = tuning.Store();
    const std::string& chosen = result.candidates[result.recommended].candidate.name;
    const bool written =
        PrintAll(options.json ? ToJson(result) + "\n" : ForTerminal(ToText(result)));
    return WriteAfterVerdict(written && result.IsBetter() ? 0 : 1, [&] {
      store.Write("recommended.xml", Headed(tuning.ProfileOf(chosen), result));
      store.Write("evidence.json", ToJson(result) + "\n");
      store.Write("report.html", ToHtml(result, Draw(PlotsOf(result), store)));
      if (options.json) return;
      const std::string folder = store.Folder().string();
      std::fprintf(stderr, "written: %s/recommended.xml, evidence.json, report.html\n",
                   folder.c_str());
    });
  } catch (const TuneInterrupted&) {
    std::fprintf(stderr, "interrupted; run the same command again to resume\n");
    return 1;
  }
}

}  // namespace giveway::fleetctl
