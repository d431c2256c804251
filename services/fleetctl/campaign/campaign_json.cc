#include "services/fleetctl/campaign/campaign_json.h"

#include <fmt/format.h>
#include <google/protobuf/util/json_util.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "services/fleetctl/campaign/campaign_identity.h"
#include "services/fleetctl/campaign/campaign_schema.h"
#include "services/report/violations.h"
#include "services/runtime/utf8.h"
#include "services/types/check.h"
#include "sim_world/virtual/generators.h"

namespace giveway::fleetctl {
namespace {

constexpr double kMostWhole = 9007199254740992.0;  // 2^53

void WriteSums(const CampaignSums& sums, schema::CampaignSums* message) {
  message->set_generator(sums.generator);
  message->set_runs(sums.runs);
  message->set_failed_runs(sums.failed_runs);
  message->set_contacts(sums.contacts);
  SetBroken(sums, message->mutable_violations());
  message->set_vehicle_ms(static_cast<double>(sums.vehicle_ms));
  message->set_delays_us(static_cast<double>(sums.delays_us));
  for (const auto& [tenths, count] : sums.delays) {
    message->add_delay_ds(tenths);
    message->add_delays(count);
  }
  if (sums.separation_m) message->set_min_separation_m(*sums.separation_m);
  SetTrust(sums.trust, message->mutable_trust());
  message->set_hash(fmt::format("{:016x}", sums.hash));
  for (const std::uint32_t seed : sums.failing_seeds) message->add_failing_seeds(seed);
}

// Collects what is wrong with a result.
class ShardComplaints {
 public:
  void Unless(bool holds, const std::string& complaint) {
    if (!holds) text_ += (text_.empty() ? "" : "; ") + complaint;
  }
  const std::string& Text() const { return text_; }

 private:
  std::string text_;
};

bool IsHex(const std::string& text, std::size_t least, std::size_t most) {
  return text.size() >= least && text.size() <= most &&
         text.find_first_not_of("0123456789abcdef") == std::string::npos;
}

std::int64_t WholeOf(double value, const std::string& field, ShardComplaints* complaints) {
  const bool whole = std::abs(value) <= kMostWhole && value == std::floor(value);
  complaints->Unless(whole, field + " is no whole number");
  return whole ? static_cast<std::int64_t>(value) : 0;
}

void ReadBroken(const schema::Violations& message, CampaignSums* sums) {
  for (std::size_t i = 0; i < sums->violations.size(); ++i) {
    const std::string name(sim::Name(static_cast<sim::Invariant>(i)));
    const auto* field = schema::Violations::descriptor()->FindFieldByName(name);
    GIVEWAY_CHECK(field != nullptr, name);
    sums->violations[i] = message.GetReflection()->GetUInt32(message, field);
  }
  sums->unmet = message.expectation();
}

TrustCounters TrustOf(const schema::Trust& message) {
  return {.beacon_without_echo = message.beacon_without_echo(),
          .echo_without_beacon = message.echo_without_beacon(),
          .halted_but_closing = message.halted_but_closing(),
          .jumps = message.jumps(),
          .impossible_speeds = message.impossible_speeds()};
}

void ReadDelays(const schema::CampaignSums& message, CampaignSums* sums,
                ShardComplaints* complaints) {
  const std::string name = sums->generator;
  complaints->Unless(message.delay_ds_size() == message.delays_size(),
                     name + ": delay_ds and delays are not equally long");
  complaints->Unless(std::ranges::is_sorted(message.delay_ds()),
                     name + ": delay_ds is not ascending");
  for (int i = 0; i < std::min(message.delay_ds_size(), message.delays_size()); ++i) {
    sums->delays[message.delay_ds(i)] += message.delays(i);
  }
}

CampaignSums SumsFrom(const schema::CampaignSums& message, ShardComplaints* complaints) {
  CampaignSums sums;
  sums.generator = message.generator();
  const std::string& name = sums.generator;
  sums.runs = message.runs();
  sums.failed_runs = message.failed_runs();
  sums.contacts = message.contacts();
  ReadBroken(message.violations(), &sums);
  sums.vehicle_ms = WholeOf(message.vehicle_ms(), name + ": vehicle_ms", complaints);
  sums.delays_us = WholeOf(message.delays_us(), name + ": delays_us", complaints);
  ReadDelays(message, &sums, complaints);
  if (message.has_min_separation_m()) {
    complaints->Unless(std::isfinite(message.min_separation_m()),
                       name + ": min_separation_m is not finite");
    sums.separation_m = message.min_separation_m();
  }
  sums.trust = TrustOf(message.trust());
  complaints->Unless(IsHex(message.hash(), 16, 16), name + ": hash is not 16 hex digits");
  if (IsHex(message.hash(), 16, 16)) sums.hash = std::stoull(message.hash(), nullptr, 16);
  sums.failing_seeds.assign(message.failing_seeds().begin(), message.failing_seeds().end());
  complaints->Unless(sums.failed_runs <= sums.runs, name + ": more failed than were run");
  const std::size_t kept = std::min<std::size_t>(sums.failed_runs, CampaignSums::kFailingKept);
  complaints->Unless(
      std::ranges::is_sorted(sums.failing_seeds) && sums.failing_seeds.size() == kept,
      name + ": failing_seeds are not those of failed_runs");
  return sums;
}

// Of the values and not of the text, so that a result may be printed again by another program.
std::string ChecksumOf(schema::CampaignShard message) {
  message.clear_checksum();
  return HashOf(message.SerializeAsString());
}

// A shard has as many runs of each generator as are dealt to it: those of another, or a part, are
// not its result. The shard's number is valid.
void CheckDeal(const ShardResult& result, ShardComplaints* complaints) {
  const std::size_t generators = result.generators.size();
  complaints->Unless(generators > 0 && result.planned_runs % generators == 0,
                     "planned_runs is not the same number for each generator");
  if (!complaints->Text().empty()) return;
  const auto seeds = static_cast<std::uint32_t>(result.planned_runs / generators);
  const ShardRuns dealt(seeds, generators, result.shard);
  for (std::size_t i = 0; i < generators; ++i) {
    const CampaignSums& sums = result.generators[i];
    complaints->Unless(sums.runs == dealt.CountOf(i),
                       fmt::format("{}: {} runs; shard {} of {} has {}", sums.generator, sums.runs,
                                   result.shard.index, result.shard.of, dealt.CountOf(i)));
  }
}

}  // namespace

std::string JsonLine(const google::protobuf::Message& message) {
  google::protobuf::util::JsonPrintOptions options;
  options.always_print_primitive_fields = true;
  options.preserve_proto_field_names = true;
  std::string json;
  const auto status = google::protobuf::util::MessageToJsonString(message, &json, options);
  GIVEWAY_CHECK(status.ok(), status.ToString());
  return json;
}

void SetBroken(const CampaignSums& sums, schema::Violations* message) {
  std::vector<BrokenInvariant> broken;
  for (std::size_t i = 0; i < sums.violations.size(); ++i) {
    broken.push_back({std::string(sim::Name(static_cast<sim::Invariant>(i))), sums.violations[i]});
  }
  broken.push_back({"expectation", sums.unmet});
  SetViolations(broken, message);
}

std::string ToJson(const ShardResult& result) {
  schema::CampaignShard message;
  message.set_format(kCampaignFormat);
  message.set_campaign(WellFormed(result.campaign));
  message.set_plan(result.plan);
  message.set_program(result.program);
  message.set_of(result.shard.of);
  message.set_index(result.shard.index);
  message.set_planned_runs(result.planned_runs);
  message.set_flags(WellFormed(result.flags));
  for (const CampaignSums& sums : result.generators) WriteSums(sums, message.add_generators());
  message.set_checksum(ChecksumOf(message));
  return JsonLine(message);
}

ReadShard ShardFromJson(std::string_view json) {
  schema::CampaignShard message;
  const auto status = google::protobuf::util::JsonStringToMessage(std::string(json), &message);
  if (!status.ok()) {
    // Below its first line the text is shown, with a mark at the place.
    const std::string why(status.message());
    return {{}, "is no result of a shard: " + why.substr(0, why.find('\n'))};
  }
  if (message.format() != kCampaignFormat) {
    return {{}, fmt::format("is of format {}, must be {}", message.format(), kCampaignFormat)};
  }
  ShardComplaints complaints;
  ReadShard read;
  ShardResult& result = read.result;
  result.campaign = message.campaign();
  result.plan = message.plan();
  result.program = message.program();
  result.shard = {message.index(), message.of()};
  result.planned_runs = message.planned_runs();
  result.flags = message.flags();
  complaints.Unless(IsHex(result.plan, 16, 16), "plan is not 16 hex digits");
  complaints.Unless(IsHex(result.program, 2, 128), "program is no build id");
  complaints.Unless(result.shard.of >= 1 && result.shard.of <= kMostShards &&
                        result.shard.index < result.shard.of,
                    fmt::format("index {} of {} shards", result.shard.index, result.shard.of));
  complaints.Unless(message.generators_size() > 0, "it has no generators");
  // A single name may be that of a scenario, whose file need not be here.
  const bool may_be_scenario = message.generators_size() == 1;
  for (const schema::CampaignSums& sums : message.generators()) {
    const std::string& name = sums.generator();
    complaints.Unless(sim::FindGenerator(name) != nullptr || (may_be_scenario && !name.empty()),
                      "\"" + name + "\" is no generator");
    result.generators.push_back(SumsFrom(sums, &complaints));
  }
  if (complaints.Text().empty()) CheckDeal(result, &complaints);
  complaints.Unless(message.checksum() == ChecksumOf(message),
                    message.checksum().empty()
                        ? "it has no checksum"
                        : "its checksum is of other contents: it was damaged or edited");
  read.complaint = complaints.Text();
  return read;
}

}  // namespace giveway::fleetctl
