#include "services/fleetctl/tune/tune_store.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>

#include "services/fleetctl/output/output_file.h"
#include "services/runtime/json.h"
#include "services/runtime/whole_file.h"

namespace giveway::fleetctl {
namespace {

namespace fs = std::filesystem;

Json CountsJson(const AlarmCounts& counts) {
  Json json;
  json["deadline"] = counts.deadline;
  json["liveliness"] = counts.liveliness;
  json["beacon_age"] = counts.beacon_age;
  return json;
}

AlarmCounts CountsFrom(const Json& json) {
  return {Uint32Of(json.at("deadline")), Uint32Of(json.at("liveliness")),
          Uint32Of(json.at("beacon_age"))};
}

AlarmCause CauseNamed(const std::string& name) {
  for (const AlarmCause cause :
       {AlarmCause::kDeadline, AlarmCause::kLiveliness, AlarmCause::kBeaconAge}) {
    if (Name(cause) == name) return cause;
  }
  throw std::invalid_argument("no such cause: " + name);
}

Json DetectionJson(const DetectionReading& detection) {
  Json json;
  json["from_kill_ms"] = detection.from_kill_ms;
  json["from_last_beacon_ms"] = detection.from_last_beacon_ms;
  json["by"] = Name(detection.cause);
  return json;
}

TrialEvidence FromJson(const Json& json) {
  TrialEvidence evidence;
  evidence.candidate = json.at("candidate").get<std::string>();
  evidence.verification = json.at("verification").get<bool>();
  evidence.trial = Uint32Of(json.at("trial"));
  evidence.seed = Uint32Of(json.at("seed"));
  evidence.trouble = json.value("trouble", "");
  evidence.vehicles = Uint32Of(json.at("vehicles"));
  evidence.alive_s = json.at("alive_s").get<double>();
  evidence.alarms = CountsFrom(json.at("alarms"));
  evidence.reported_deadline = Uint32Of(json.at("told_deadline"));
  evidence.reported_liveliness = Uint32Of(json.at("told_liveliness"));
  evidence.age_mean_ms = json.at("age_mean_ms").get<double>();
  evidence.age_p99_ms = json.at("age_p99_ms").get<double>();
  if (json.contains("heard_bytes_s")) evidence.heard_bytes_s = json["heard_bytes_s"].get<double>();
  evidence.cpu_share = json.at("cpu_share").get<double>();
  evidence.longest_pause_ms = json.at("longest_pause_ms").get<double>();
  evidence.undetected = Uint32Of(json.at("undetected"));
  for (const Json& one : json.at("detections")) {
    evidence.detections.push_back({one.at("from_kill_ms").get<double>(),
                                   one.at("from_last_beacon_ms").get<double>(),
                                   CauseNamed(one.at("by").get<std::string>())});
  }
  return evidence;
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

Json EvidenceJson(const TrialEvidence& evidence) {
  Json json;
  json["candidate"] = evidence.candidate;
  json["verification"] = evidence.verification;
  json["trial"] = evidence.trial;
  json["seed"] = evidence.seed;
  if (!evidence.trouble.empty()) json["trouble"] = evidence.trouble;
  json["vehicles"] = evidence.vehicles;
  json["alive_s"] = evidence.alive_s;
  json["alarms"] = CountsJson(evidence.alarms);
  json["told_deadline"] = evidence.reported_deadline;
  json["told_liveliness"] = evidence.reported_liveliness;
  json["age_mean_ms"] = evidence.age_mean_ms;
  json["age_p99_ms"] = evidence.age_p99_ms;
  json["heard_bytes_s"] = OrNull(evidence.heard_bytes_s);
  json["cpu_share"] = evidence.cpu_share;
  json["longest_pause_ms"] = evidence.longest_pause_ms;
  json["detections"] = JsonArray(evidence.detections, DetectionJson);
  json["undetected"] = evidence.undetected;
  return json;
}

std::string ToJson(const TrialEvidence& evidence) { return JsonText(EvidenceJson(evidence)); }

std::optional<TrialEvidence> EvidenceFrom(const std::string& json) {
  const auto read = ReadJson(json);
  if (!read) return std::nullopt;
  try {
    return FromJson(*read);
  } catch (const std::exception&) {  // something is missing, or is not what it must be
    return std::nullopt;
  }
}

TuneStore::TuneStore(fs::path folder, const std::string& plan) : folder_(std::move(folder)) {
  MakeFolder(folder_ / "profiles");
  MakeFolder(folder_ / "trials");
  const fs::path plan_file = folder_ / "plan.json";
  if (fs::exists(plan_file) && ReadWholeFile(plan_file).value_or("") != plan + "\n") {
    throw OutputError(
        folder_.string() +
        " holds the evidence of another search, or of other programs (plan.json says which); "
        "give its arguments to resume it, or another --out");
  }
  Write("plan.json", plan + "\n");
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder_ / "trials")) {
    if (entry.path().extension() == ".json") files.push_back(entry.path());
  }
  std::ranges::sort(files);
  for (const fs::path& file : files) {
    // A file that cannot be read is measured again.
    if (auto evidence = EvidenceFrom(ReadWholeFile(file).value_or("")))
      found_.push_back(std::move(*evidence));
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
