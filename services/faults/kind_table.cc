#include "services/faults/kind_table.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <vector>

#include "services/types/check.h"
#include "services/types/nearest_name.h"

namespace giveway::faults {
namespace {

using N = Quantity;

// From the least that has an effect on.
constexpr std::array kSlowNumbers = {QuantityRow{N::kShare, 0.2, 0.01, 0.95}};
constexpr std::array kMemoryNumbers = {QuantityRow{N::kBytes, 8e6, 1, 1e12}};
constexpr std::array kDescriptorNumbers = {QuantityRow{N::kCount, 4, 1, 100000}};
constexpr std::array kClockQuantities = {QuantityRow{N::kOffset, 3600, -86400, 86400}};
constexpr std::array kChurnNumbers = {QuantityRow{N::kCount, 20, 1, 100000}};
constexpr std::array kLeftOverNumbers = {QuantityRow{N::kCount, 50, 1, 100000}};
constexpr std::array kLossNumbers = {QuantityRow{N::kProbability, 0.2, 0.001, 1}};
// A length from 10 on lets every probability up to 0.9 be reached: services/config/impair.cc.
constexpr std::array kBurstNumbers = {QuantityRow{N::kProbability, 0.2, 0.001, 0.9},
                                      QuantityRow{N::kCount, 10, 10, 10000}};
constexpr std::array kDelayNumbers = {QuantityRow{N::kDelay, 0.05, 0.001, 10}};
constexpr std::array kReorderNumbers = {QuantityRow{N::kProbability, 0.1, 0.001, 1},
                                        QuantityRow{N::kDelay, 0.075, 0.001, 10}};
constexpr std::array kDuplicateNumbers = {QuantityRow{N::kProbability, 0.1, 0.001, 1}};
constexpr std::array kCorruptNumbers = {QuantityRow{N::kProbability, 0.01, 0.001, 1}};
constexpr std::array kRateNumbers = {QuantityRow{N::kBytes, 20000, 1, 1e9}};
constexpr std::array kFlappingNumbers = {QuantityRow{N::kPeriod, 2, 0.05, 600}};
constexpr std::array kWrongNumbers = {QuantityRow{N::kFactor, 0.8, 0, 10}};
constexpr std::array kSonarSlowNumbers = {QuantityRow{N::kPeriod, 0.5, 0.05, 600}};
constexpr std::array kSonarDelayedNumbers = {QuantityRow{N::kDelay, 0.1, 0.001, 10}};
constexpr std::array kIntermittentNumbers = {QuantityRow{N::kProbability, 0.3, 0.001, 1}};
constexpr std::array kWeakQuantities = {QuantityRow{N::kFactor, 0.7, 0, 10}};
constexpr std::array kEncoderNumbers = {QuantityRow{N::kFactor, 1.02, 0, 10}};
// Off by far more than a fix can be by chance, and by no more than wheels could have gone.
constexpr std::array kFixNumbers = {QuantityRow{N::kProbability, 0.5, 0.001, 1},
                                    QuantityRow{N::kFactor, 8, 0, 10}};
constexpr std::array kForgedNumbers = {QuantityRow{N::kRate, 20, 1, 100000}};
constexpr std::array kFloodNumbers = {QuantityRow{N::kRate, 2000, 1, 100000}};
constexpr std::array kMalformedNumbers = {QuantityRow{N::kRate, 50, 1, 100000}};

constexpr Actor kS = Actor::kSupervisor;
constexpr Actor kH = Actor::kHearer;
constexpr Actor kW = Actor::kWorld;
constexpr Actor kA = Actor::kAttacker;
constexpr unsigned kProcess = kOnVehicle | kOnWorld;
constexpr unsigned kAnyProcess = kProcess | kOnServer;
constexpr unsigned kOneOrAllVehicles = kOnVehicle | kOnAll;
constexpr bool kInstant = false;
constexpr bool kLasts = true;
constexpr bool kReal = false;
constexpr bool kVirtualToo = true;

// kill: of a vehicle or a server only. A fleet without its world cannot heal, so that is restarted.
constexpr std::array<KindRow, kKinds> kTable = {{
    {Kind::kKill,
     "kill",
     kS,
     kOnVehicle | kOnServer,
     kInstant,
     kVirtualToo,
     {},
     false,
     "",
     "is killed and does not come back"},
    {Kind::kRestart,
     "restart",
     kS,
     kAnyProcess | kOnAll,
     kLasts,
     kVirtualToo,
     {},
     false,
     "",
     "is killed, and started again after for_s"},
    {Kind::kPause,
     "pause",
     kS,
     kAnyProcess | kOnAll,
     kLasts,
     kVirtualToo,
     {},
     false,
     "",
     "is stopped as a whole, and resumes"},
    {Kind::kHang,
     "hang",
     kS,
     kOnVehicle,
     kLasts,
     kVirtualToo,
     {},
     false,
     "",
     "its control loop hangs, its other threads run on"},
    {Kind::kSlow, "slow", kS, kProcess, kLasts, kVirtualToo, kSlowNumbers, false, "",
     "gets a share of one processor"},
    {Kind::kMemoryLimit, "memory_limit", kS, kProcess, kLasts, kReal, kMemoryNumbers, false, "",
     "may use so much memory more than it does"},
    {Kind::kDescriptorLimit, "descriptor_limit", kS, kProcess, kLasts, kReal, kDescriptorNumbers,
     false, "", "may open so many files more than it has"},
    {Kind::kDiskFull,
     "disk_full",
     kS,
     kOnVehicle,
     kLasts,
     kReal,
     {},
     false,
     "",
     "what it records cannot be written"},
    {Kind::kLogReaderStops,
     "log_reader_stops",
     kS,
     kProcess,
     kLasts,
     kReal,
     {},
     false,
     "",
     "its stderr is not read"},
    {Kind::kClockStep, "clock_step", kS, kProcess | kOnAll, kLasts, kReal, kClockQuantities, false,
     "", "its system clock jumps, and back"},
    {Kind::kQosMismatch,
     "qos_mismatch",
     kS,
     kOnVehicle,
     kLasts,
     kReal,
     {},
     false,
     "lossy_radio",
     "restarts with a profile set that does not match the others'"},
    {Kind::kQosApply,
     "qos_apply",
     kS,
     kOnVehicle | kOnAll,
     kLasts,
     kReal,
     {},
     false,
     kPatientReaders,
     "is ordered over DDS to take a profile set or patient readers, then its own"},
    {Kind::kDuplicateId,
     "duplicate_id",
     kS,
     kOnVehicle,
     kLasts,
     kReal,
     {},
     false,
     "",
     "a second process has its id"},
    {Kind::kChurn, "churn", kS, kOnAll, kLasts, kReal, kChurnNumbers, false, "",
     "so many processes join and are killed, one after the other"},
    {Kind::kSharedMemoryGone,
     "shared_memory_gone",
     kS,
     kOnAll,
     kInstant,
     kReal,
     {},
     false,
     "",
     "what is in /dev/shm is deleted while it is used"},
    {Kind::kSharedMemoryLeftOver, "shared_memory_left_over", kS, kOnAll, kLasts, kReal,
     kLeftOverNumbers, false, "", "so many segments of dead processes lie in /dev/shm"},
    {Kind::kSharedMemorySmall,
     "shared_memory_small",
     kS,
     kOnAll,
     kLasts,
     kReal,
     {},
     false,
     "",
     "/dev/shm is full"},
    {Kind::kLoss, "loss", kH, kOneOrAllVehicles, kLasts, kVirtualToo, kLossNumbers, false, "",
     "loses packets of vehicles, each by itself"},
    {Kind::kBurst, "burst", kH, kOneOrAllVehicles, kLasts, kVirtualToo, kBurstNumbers, false, "",
     "loses packets of vehicles in rows: a share of them, so many in a row"},
    {Kind::kDelay, "delay", kH, kOneOrAllVehicles, kLasts, kVirtualToo, kDelayNumbers, false, "",
     "hears vehicles late"},
    {Kind::kReorder, "reorder", kH, kOneOrAllVehicles, kLasts, kVirtualToo, kReorderNumbers, false,
     "", "some packets come so much later and are overtaken"},
    {Kind::kDuplicate, "duplicate", kH, kOneOrAllVehicles, kLasts, kVirtualToo, kDuplicateNumbers,
     false, "", "some packets come twice"},
    {Kind::kCorrupt, "corrupt", kH, kOneOrAllVehicles, kLasts, kReal, kCorruptNumbers, false, "",
     "one bit of some packets is turned round"},
    {Kind::kRate, "rate", kH, kOneOrAllVehicles, kLasts, kReal, kRateNumbers, false, "",
     "hears so many bytes a second of each vehicle"},
    {Kind::kOneWayCut,
     "one_way_cut",
     kH,
     kOneOrAllVehicles,
     kLasts,
     kVirtualToo,
     {},
     true,
     "",
     "does not hear one vehicle, or none, and is heard"},
    {Kind::kPartition,
     "partition",
     kH,
     kOneOrAllVehicles,
     kLasts,
     kVirtualToo,
     {},
     false,
     "",
     "it and the other vehicles do not hear each other"},
    {Kind::kFlapping, "flapping", kH, kOneOrAllVehicles, kLasts, kVirtualToo, kFlappingNumbers,
     false, "", "as partition, for the first half of each period"},
    {Kind::kSonarOff,
     "sonar_off",
     kW,
     kOneOrAllVehicles,
     kLasts,
     kVirtualToo,
     {},
     false,
     "",
     "its ultrasonics have no echo"},
    {Kind::kSonarStuck,
     "sonar_stuck",
     kW,
     kOneOrAllVehicles,
     kLasts,
     kVirtualToo,
     {},
     false,
     "",
     "its ultrasonics repeat what they said when the fault started"},
    {Kind::kSonarGarbage,
     "sonar_garbage",
     kW,
     kOneOrAllVehicles,
     kLasts,
     kVirtualToo,
     {},
     false,
     "",
     "its ultrasonics say anything"},
    {Kind::kSonarWrong, "sonar_wrong", kW, kOneOrAllVehicles, kLasts, kVirtualToo, kWrongNumbers,
     false, "", "its ranges are multiplied"},
    {Kind::kSonarSlow, "sonar_slow", kW, kOneOrAllVehicles, kLasts, kVirtualToo, kSonarSlowNumbers,
     false, "", "its ranges are new once a period"},
    {Kind::kSonarDelayed, "sonar_delayed", kW, kOneOrAllVehicles, kLasts, kVirtualToo,
     kSonarDelayedNumbers, false, "", "its ranges are of some time ago"},
    {Kind::kSonarIntermittent, "sonar_intermittent", kW, kOneOrAllVehicles, kLasts, kVirtualToo,
     kIntermittentNumbers, false, "", "some scans are without echoes"},
    {Kind::kMotorWeak, "motor_weak", kW, kOneOrAllVehicles, kLasts, kVirtualToo, kWeakQuantities,
     false, "", "its wheels reach a part of what was commanded"},
    {Kind::kMotorStuck,
     "motor_stuck",
     kW,
     kOneOrAllVehicles,
     kLasts,
     kVirtualToo,
     {},
     false,
     "",
     "its wheels keep turning as they did when the fault started"},
    {Kind::kEncoderWrong, "encoder_wrong", kW, kOneOrAllVehicles, kLasts, kVirtualToo,
     kEncoderNumbers, false, "", "its encoders count a multiple of what the wheels turn"},
    {Kind::kPoseFixLost,
     "pose_fix_lost",
     kW,
     kOneOrAllVehicles,
     kLasts,
     kVirtualToo,
     {},
     false,
     "",
     "it has no pose fixes"},
    {Kind::kPoseFixWrong, "pose_fix_wrong", kW, kOneOrAllVehicles, kLasts, kVirtualToo, kFixNumbers,
     false, "", "some of its pose fixes are off by a multiple of their standard deviation"},
    {Kind::kSpoofed, "spoofed", kA, kOnVehicle, kLasts, kReal, kForgedNumbers, false, "",
     "beacons of another come under its id"},
    {Kind::kReplayed, "replayed", kA, kOnVehicle, kLasts, kReal, kForgedNumbers, false, "",
     "its earlier beacons are sent again"},
    {Kind::kFlooded, "flooded", kA, kOnVehicle | kOnAll, kLasts, kReal, kFloodNumbers, false, "",
     "gets so many packets a second that are none of the fleet"},
    {Kind::kMalformed, "malformed", kA, kOnVehicle | kOnAll, kLasts, kReal, kMalformedNumbers,
     false, "", "gets packets that no library would send"},
}};

constexpr bool InOrder() {
  for (std::size_t i = 0; i < kTable.size(); ++i) {
    if (static_cast<std::size_t>(kTable[i].kind) != i || kTable[i].word.empty()) return false;
  }
  return true;
}
static_assert(InOrder());

struct NumberMember {
  std::string_view field;
  std::string_view unit;
  std::optional<double> Parameters::*member;
};

// In the order of Quantity; the last is `count`, the only whole one.
constexpr std::array<NumberMember, kQuantities - 1> kMembers = {{
    {"probability", "", &Parameters::probability},
    {"share", "", &Parameters::share},
    {"factor", "", &Parameters::factor},
    {"delay_s", "s", &Parameters::delay_s},
    {"period_s", "s", &Parameters::period_s},
    {"offset_s", "s", &Parameters::offset_s},
    {"rate_hz", "Hz", &Parameters::rate_hz},
    {"bytes", "bytes", &Parameters::bytes},
}};

constexpr std::size_t kLongestWord = 64;  // of one that is compared

}  // namespace

std::string_view ToString(Kind kind) { return RowOf(kind).word; }

std::optional<Kind> KindOf(std::string_view word) {
  const auto row = std::ranges::find(kTable, word, &KindRow::word);
  if (row == kTable.end()) return std::nullopt;
  return row->kind;
}

Actor ActorOf(Kind kind) { return RowOf(kind).actor; }

std::string_view FieldOf(Quantity quantity) {
  return quantity == Quantity::kCount ? "count"
                                      : kMembers[static_cast<std::size_t>(quantity)].field;
}

std::string_view UnitOf(Quantity quantity) {
  return quantity == Quantity::kCount ? "" : kMembers[static_cast<std::size_t>(quantity)].unit;
}

std::optional<double> Get(const Parameters& parameters, Quantity quantity) {
  if (quantity != Quantity::kCount)
    return parameters.*kMembers[static_cast<std::size_t>(quantity)].member;
  if (!parameters.count) return std::nullopt;
  return static_cast<double>(*parameters.count);
}

void Set(Parameters* parameters, Quantity quantity, double value) {
  if (quantity == Quantity::kCount) {
    parameters->count = static_cast<std::uint32_t>(value);
  } else {
    parameters->*kMembers[static_cast<std::size_t>(quantity)].member = value;
  }
}

std::span<const KindRow> KindTable() { return kTable; }

const KindRow& RowOf(Kind kind) { return kTable[static_cast<std::size_t>(kind)]; }

const QuantityRow* RowOf(Kind kind, Quantity quantity) {
  const auto numbers = RowOf(kind).numbers;
  const auto row = std::ranges::find(numbers, quantity, &QuantityRow::quantity);
  return row == numbers.end() ? nullptr : &*row;
}

std::string_view ToString(Actor actor) {
  switch (actor) {
    case Actor::kSupervisor:
      return "supervisor";
    case Actor::kHearer:
      return "hearer";
    case Actor::kWorld:
      return "world";
    case Actor::kAttacker:
      return "attacker";
  }
  return "";
}

std::string_view ToString(Target::What what) {
  switch (what) {
    case Target::What::kVehicle:
      return "vehicle";
    case Target::What::kWorld:
      return "world";
    case Target::What::kDiscoveryServer:
      return "discovery_server";
    case Target::What::kAll:
      return "all";
  }
  return "";
}

std::string ToString(const Target& target) {
  std::string words(ToString(target.what));
  if (target.what == Target::What::kVehicle) {
    words += ' ' + std::to_string(Number(target.vehicle));
  }
  return words;
}

std::string TargetsOf(const KindRow& row) {
  std::vector<std::string_view> words;
  for (const auto what : {Target::What::kVehicle, Target::What::kWorld,
                          Target::What::kDiscoveryServer, Target::What::kAll}) {
    if (row.Allows(what)) words.push_back(ToString(what));
  }
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (i > 0) text += i + 1 == words.size() ? " or " : ", ";
    text += words[i];
  }
  return text;
}

std::string_view NearestKind(std::string_view word) {
  word = word.substr(0, kLongestWord);
  // The start of a word stands for it, however much is missing.
  const auto begun = std::ranges::find_if(
      kTable, [&](const KindRow& row) { return word.size() > 2 && row.word.starts_with(word); });
  if (begun != kTable.end()) return begun->word;
  return std::ranges::min_element(kTable, {},
                                  [&](const KindRow& row) { return EditDistance(word, row.word); })
      ->word;
}

Parameters Filled(Kind kind, Parameters parameters) {
  const KindRow& row = RowOf(kind);
  for (const QuantityRow& taken : row.numbers) {
    if (!Get(parameters, taken.quantity)) Set(&parameters, taken.quantity, taken.usual);
  }
  if (parameters.qos.empty()) parameters.qos = row.usual_qos;
  return parameters;
}

}  // namespace giveway::faults
