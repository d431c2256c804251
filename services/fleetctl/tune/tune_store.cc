// Boost's own JSON parser includes what Boost deprecates.
#define BOOST_BIND_GLOBAL_PLACEHOLDERS
#include "services/fleetctl/tune/tune_store.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/property_tree/json_parser.hpp>
#include <boost/property_tree/ptree.hpp>
#include <fstream>
#include <iterator>
#include <sstream>

#include "services/fleetctl/output/output_file.h"
#include "services/observer/fleet/json_object.h"

namespace giveway::fleetctl {
namespace {

namespace fs = std::filesystem;
using boost::property_tree::ptree;

JsonObject CountsJson(const AlarmCounts& counts) {
  JsonObject json;
  json.Add("deadline", counts.deadline);
  json.Add("liveliness", counts.liveliness);
  json.Add("beacon_age", counts.beacon_age);
  return json;
}

AlarmCounts CountsFrom(const ptree& json) {
  return {json.get<std::uint32_t>("deadline"), json.get<std::uint32_t>("liveliness"),
          json.get<std::uint32_t>("beacon_age")};
}

AlarmCause CauseNamed(const std::string& name) {
  for (const AlarmCause cause :
       {AlarmCause::kDeadline, AlarmCause::kLiveliness, AlarmCause::kBeaconAge}) {
    if (Name(cause) == name) return cause;
  }
  throw boost::property_tree::ptree_error("no such cause: " + name);
}

std::string DetectionsJson(const std::vector<DetectionReading>& detections) {
  return JsonArray(detections, [](const DetectionReading& detection) {
    JsonObject object;
    object.Add("from_kill_ms", detection.from_kill_ms);
    object.Add("from_last_beacon_ms", detection.from_last_beacon_ms);
    object.Add("by", Name(detection.cause));
    return object.Text();
  });
}

TrialEvidence FromTree(const ptree& json) {
  TrialEvidence evidence;
  evidence.candidate = json.get<std::string>("candidate");
  evidence.verification = json.get<bool>("verification");
  evidence.trial = json.get<std::uint32_t>("trial");
  evidence.seed = json.get<std::uint32_t>("seed");
  evidence.trouble = json.get<std::string>("trouble", "");
  evidence.vehicles = json.get<std::uint32_t>("vehicles");
  evidence.alive_s = json.get<double>("alive_s");
  evidence.alarms = CountsFrom(json.get_child("alarms"));
  evidence.told_deadline = json.get<std::uint32_t>("told_deadline");
  evidence.told_liveliness = json.get<std::uint32_t>("told_liveliness");
  evidence.age_mean_ms = json.get<double>("age_mean_ms");
  evidence.age_p99_ms = json.get<double>("age_p99_ms");
  if (const auto bytes = json.get_optional<double>("heard_bytes_s")) {
    evidence.heard_bytes_s = *bytes;
  }
  evidence.cpu_share = json.get<double>("cpu_share");
  evidence.longest_pause_ms = json.get<double>("longest_pause_ms");
  evidence.undetected = json.get<std::uint32_t>("undetected");
  for (const auto& [name, one] : json.get_child("detections")) {
    evidence.detections.push_back({one.get<double>("from_kill_ms"),
                                   one.get<double>("from_last_beacon_ms"),
                                   CauseNamed(one.get<std::string>("by"))});
  }
  return evidence;
}

std::string ReadAll(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

void MakeFolder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) {
    throw OutputError("cannot write " + folder.string() + ": " + error.message() +
                      "; name a folder that is yours to write");
  }
}

}  // namespace

std::string ToJson(const TrialEvidence& evidence) {
  JsonObject json;
  json.Add("candidate", std::string_view(evidence.candidate));
  json.Add("verification", evidence.verification);
  json.Add("trial", evidence.trial);
  json.Add("seed", evidence.seed);
  if (!evidence.trouble.empty()) json.Add("trouble", std::string_view(evidence.trouble));
  json.Add("vehicles", evidence.vehicles);
  json.Add("alive_s", evidence.alive_s);
  json.Add("alarms", CountsJson(evidence.alarms));
  json.Add("told_deadline", evidence.told_deadline);
  json.Add("told_liveliness", evidence.told_liveliness);
  json.Add("age_mean_ms", evidence.age_mean_ms);
  json.Add("age_p99_ms", evidence.age_p99_ms);
  json.Add("heard_bytes_s", evidence.heard_bytes_s);
  json.Add("cpu_share", evidence.cpu_share);
  json.Add("longest_pause_ms", evidence.longest_pause_ms);
  json.AddRaw("detections", DetectionsJson(evidence.detections));
  json.Add("undetected", evidence.undetected);
  return json.Text();
}

std::optional<TrialEvidence> EvidenceFrom(const std::string& json) {
  try {
    std::istringstream stream(json);
    ptree tree;
    boost::property_tree::read_json(stream, tree);
    return FromTree(tree);
  } catch (const boost::property_tree::ptree_error&) {
    return std::nullopt;
  }
}

TuneStore::TuneStore(fs::path folder, const std::string& plan) : folder_(std::move(folder)) {
  MakeFolder(folder_ / "profiles");
  MakeFolder(folder_ / "trials");
  const fs::path plan_file = folder_ / "plan.json";
  if (fs::exists(plan_file) && ReadAll(plan_file) != plan + "\n") {
    throw OutputError(folder_.string() +
                      " holds the evidence of another search (plan.json says which); give its "
                      "arguments to resume it, or another --out");
  }
  Write("plan.json", plan + "\n");
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder_ / "trials")) {
    if (entry.path().extension() == ".json") files.push_back(entry.path());
  }
  std::ranges::sort(files);
  for (const fs::path& file : files) {
    // A file that cannot be read is measured again.
    if (auto evidence = EvidenceFrom(ReadAll(file))) found_.push_back(std::move(*evidence));
  }
}

void TuneStore::Keep(const TrialEvidence& evidence) const {
  Write(fmt::format("trials/{}{}-{}.json", evidence.verification ? "verify-" : "",
                    evidence.candidate, evidence.trial),
        ToJson(evidence) + "\n");
}

void TuneStore::Write(const std::string& name, const std::string& text) const {
  WriteFile((folder_ / name).string(), text);
}

}  // namespace giveway::fleetctl
