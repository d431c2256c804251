#include "services/fleetctl/tune/tune_report.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <utility>

#include "services/fleetctl/tune/tune_store.h"
#include "services/runtime/json.h"

namespace giveway::fleetctl {
namespace {

constexpr const char* kHead =
    "  candidate               alarms per vehicle-hour       noticed after, ms    age  heard    "
    "CPU\n"
    "                           measured (99 %)  predicted   mean  pred.   max     ms   kB/s      "
    "%\n";

std::string Optional(const std::optional<double>& value, int width, int digits) {
  return value ? fmt::format("{:>{}.{}f}", *value, width, digits)
               : fmt::format("{:>{}}", "-", width);
}

std::string Line(const TunedCandidate& tuned) {
  std::string line = fmt::format("{} {:<21}", tuned.on_front ? "*" : " ", tuned.candidate.name);
  if (!tuned.figures) return line + " not measured: " + tuned.trouble + "\n";
  const TuneFigures& f = *tuned.figures;
  std::optional<double> alarms;
  std::optional<double> detection;
  if (tuned.predicted) {
    alarms = tuned.predicted->alarms_per_hour;
    detection = tuned.predicted->detection_ms;
  }
  std::optional<double> heard;
  if (f.heard_bytes_s) heard = *f.heard_bytes_s / 1000;
  line += fmt::format(" {:>7.0f} ({:.0f}..{:.0f})", f.alarms_per_hour, f.alarms_low, f.alarms_high);
  line.resize(std::max<std::size_t>(line.size(), 44), ' ');
  line += fmt::format("{} {:>6.0f} {} {:>5.0f} {:>6.1f} {} {:>6.1f}", Optional(alarms, 9, 0),
                      f.detection_ms, Optional(detection, 6, 0), f.detection_max_ms, f.age_mean_ms,
                      Optional(heard, 6, 1), f.cpu_share * 100);
  if (f.undetected > 0) line += fmt::format("  {} times not noticed", f.undetected);
  if (!tuned.disagreement.empty()) line += "  ! " + tuned.disagreement;
  return line + "\n";
}

Json FiguresJson(const TuneFigures& f) {
  Json json;
  json["trials"] = f.trials;
  json["vehicle_hours"] = f.vehicle_hours;
  json["alarms"] = f.alarms.Total();
  json["alarms_by_deadline"] = f.alarms.deadline;
  json["alarms_by_liveliness"] = f.alarms.liveliness;
  json["alarms_by_beacon_age"] = f.alarms.beacon_age;
  json["alarms_per_vehicle_hour"] = f.alarms_per_hour;
  json["alarms_dispersion"] = f.dispersion;
  json["alarms_low"] = f.alarms_low;
  json["alarms_high"] = f.alarms_high;
  json["told_per_vehicle_hour"] = f.reported_per_hour;
  json["detections"] = f.detections;
  json["undetected"] = f.undetected;
  json["detection_ms"] = f.detection_ms;
  json["detection_error_ms"] = f.detection_error_ms;
  json["detection_max_ms"] = f.detection_max_ms;
  json["detection_from_kill_ms"] = f.detection_from_kill_ms;
  json["beacon_age_mean_ms"] = f.age_mean_ms;
  json["beacon_age_p99_ms"] = f.age_p99_ms;
  json["heard_bytes_s"] = OrNull(f.heard_bytes_s);
  json["cpu_share"] = f.cpu_share;
  json["longest_pause_ms"] = f.longest_pause_ms;
  return json;
}

Json CandidateJson(const TunedCandidate& tuned) {
  const BeaconQos& qos = tuned.candidate.qos;
  Json json;
  json["name"] = tuned.candidate.name;
  json["deadline_offered_ms"] = Milliseconds(qos.offered);
  json["deadline_requested_ms"] = Milliseconds(qos.requested);
  json["lease_ms"] = Milliseconds(qos.lease);
  json["reliable"] = qos.reliable;
  json["reader_depth"] = qos.depth;
  json["on_front"] = tuned.on_front;
  if (tuned.figures) json["measured"] = FiguresJson(*tuned.figures);
  if (tuned.predicted) {
    Json predicted;
    predicted["alarms_per_vehicle_hour"] = tuned.predicted->alarms_per_hour;
    predicted["detection_ms"] = tuned.predicted->detection_ms;
    predicted["beacon_age_mean_ms"] = tuned.predicted->age_mean_ms;
    json["predicted"] = std::move(predicted);
  }
  if (!tuned.disagreement.empty()) {
    json["disagreement"] = tuned.disagreement;
  }
  if (!tuned.trouble.empty()) json["trouble"] = tuned.trouble;
  return json;
}

std::string VerifiedLine(const char* name, const TuneFigures& f) {
  return fmt::format(
      "  {:<12} {:.0f} alarms per vehicle-hour ({} in {:.3f} h), noticed after {:.0f} +- {:.0f} "
      "ms\n",
      name, f.alarms_per_hour, f.alarms.Total(), f.vehicle_hours, f.detection_ms,
      f.detection_error_ms);
}

}  // namespace

std::string QosText(const BeaconQos& qos) {
  return fmt::format("deadline {} ms (offered {}), lease {} ms, {}, depth {}",
                     Milliseconds(qos.requested), Milliseconds(qos.offered),
                     Milliseconds(qos.lease), qos.reliable ? "reliable" : "best effort", qos.depth);
}

std::string VerdictText(const TuneResult& result) {
  const TunedCandidate& chosen = result.candidates.at(result.recommended);
  if (result.recommended == 0) return "Recommended: the base; nothing that was tried beats it.\n";
  std::string text =
      fmt::format("Recommended: {}: {}\n", chosen.candidate.name, QosText(chosen.candidate.qos));
  if (!result.verified) return text + "It was not verified: the fresh runs could not be made.\n";
  text += "Fresh runs with other seeds:\n" + VerifiedLine("base", result.verified->base) +
          VerifiedLine("recommended", result.verified->recommended);
  if (result.IsBetter()) return text + "Verified: fewer false alarms, and noticed no later.\n";
  text += "NOT verified:";
  if (!result.verified->fewer_alarms) text += " false alarms are not fewer beyond chance.";
  if (!result.verified->no_later) text += " Dead vehicles are noticed later.";
  return text + "\n";
}

std::string ToText(const TuneResult& result) {
  std::string text =
      fmt::format("{} vehicles, {} ms a tick, impaired by {}; base {}\n\n{}", result.fleet.vehicles,
                  result.fleet.tick_ms, result.impair, result.base_file, kHead);
  for (const TunedCandidate& tuned : result.candidates) text += Line(tuned);
  text +=
      "\n* nothing tried has both fewer alarms and earlier notice. ! measured and predicted "
      "differ\n"
      "beyond chance. Noticed: from the target's last beacon to the loop cycle that acts on its "
      "silence.\n\n";
  return text + VerdictText(result);
}

std::string ToJson(const TuneResult& result) {
  const auto name = [&](std::size_t place) { return result.candidates[place].candidate.name; };
  Json json;
  json["base"] = result.base_file;
  json["impair"] = result.impair;
  json["vehicles"] = result.fleet.vehicles;
  json["tick_ms"] = result.fleet.tick_ms;
  json["seed"] = result.seed;
  json["alive_s"] = result.alive_s;
  json["verified"] = result.IsBetter();
  json["recommended"] = name(result.recommended);
  json["front"] = JsonArray(result.front, name);
  if (result.verified) {
    Json verification;
    verification["base"] = FiguresJson(result.verified->base);
    verification["recommended"] = FiguresJson(result.verified->recommended);
    verification["fewer_alarms"] = result.verified->fewer_alarms;
    verification["no_later"] = result.verified->no_later;
    json["verification"] = std::move(verification);
  }
  json["candidates"] = JsonArray(result.candidates, CandidateJson);
  json["trials"] = JsonArray(result.trials, EvidenceJson);
  return JsonText(std::move(json));
}

}  // namespace giveway::fleetctl
