#include "tests/link/random_qos.h"

#include <array>

namespace giveway::test {
namespace {

class Dice {
 public:
  explicit Dice(Random* random) : random_(*random) {}
  std::size_t Below(std::size_t below) { return random_.Next() % below; }
  bool OneIn(std::size_t count) { return Below(count) == 0; }
  template <typename Range>
  auto OneOf(const Range& range) {
    return range[Below(range.size())];
  }

 private:
  Random& random_;
};

constexpr std::array kReliabilities = {"BEST_EFFORT", "RELIABLE"};
constexpr std::array kDurabilities = {"VOLATILE", "TRANSIENT_LOCAL", "TRANSIENT", "PERSISTENT"};
constexpr std::size_t kDurabilitiesThatCanBeMade = 2;
constexpr std::array kLivelinesses = {"AUTOMATIC", "MANUAL_BY_PARTICIPANT", "MANUAL_BY_TOPIC"};
constexpr std::array kOwnerships = {"SHARED", "EXCLUSIVE"};
constexpr int kLongest = -1;  // the most that a profile can say in seconds: not yet infinite
constexpr std::array kMilliseconds = {0, 300, 400, 1500, kLongest};  // 0: infinite

std::string Duration(const std::string& element, int milliseconds) {
  if (milliseconds == 0) return "<" + element + ">DURATION_INFINITY</" + element + ">";
  if (milliseconds == kLongest) {
    return "<" + element + "><sec>2147483647</sec></" + element + ">";
  }
  return "<" + element + "><sec>" + std::to_string(milliseconds / 1000) + "</sec><nanosec>" +
         std::to_string(milliseconds % 1000 * 1'000'000) + "</nanosec></" + element + ">";
}

std::string Kind(const std::string& element, const std::string& kind) {
  return "<" + element + "><kind>" + kind + "</kind></" + element + ">";
}

struct Drawn {
  std::size_t reliability = 0;
  std::size_t durability = 0;
  std::size_t liveliness = 0;
  std::size_t ownership = 0;
  std::size_t deadline = 0;
  std::size_t lease = 0;
  bool without_acks = false;
  int latency_ms = 1;
};

Drawn Draw(Dice* dice) {
  return {.reliability = dice->Below(kReliabilities.size()),
          .durability = dice->Below(kDurabilitiesThatCanBeMade),
          .liveliness = dice->Below(kLivelinesses.size()),
          .ownership = dice->Below(kOwnerships.size()),
          .deadline = dice->Below(kMilliseconds.size()),
          .lease = dice->Below(kMilliseconds.size()),
          .without_acks = dice->OneIn(6),
          .latency_ms = 1 + static_cast<int>(dice->Below(9))};
}

// The other side agrees on most, or hardly any pair would match.
Drawn Like(const Drawn& one, Dice* dice) {
  constexpr std::size_t kRarely = 5;
  Drawn other = Draw(dice);
  if (!dice->OneIn(kRarely)) other.reliability = one.reliability;
  if (!dice->OneIn(kRarely)) other.durability = one.durability;
  if (!dice->OneIn(kRarely)) other.liveliness = one.liveliness;
  if (!dice->OneIn(kRarely)) other.ownership = one.ownership;
  if (!dice->OneIn(kRarely)) other.deadline = one.deadline;
  if (!dice->OneIn(kRarely)) other.lease = one.lease;
  if (!dice->OneIn(kRarely)) other.without_acks = one.without_acks;
  return other;
}

std::string Profile(const std::string& element, const std::string& name, const Drawn& drawn) {
  std::string qos = Kind("reliability", kReliabilities[drawn.reliability]) +
                    Kind("durability", kDurabilities[drawn.durability]) +
                    Kind("ownership", kOwnerships[drawn.ownership]) + "<deadline>" +
                    Duration("period", kMilliseconds[drawn.deadline]) +
                    "</deadline><liveliness><kind>" + kLivelinesses[drawn.liveliness] + "</kind>" +
                    Duration("lease_duration", kMilliseconds[drawn.lease]) +
                    Duration("announcement_period", 100) + "</liveliness><latencyBudget>" +
                    Duration("duration", drawn.latency_ms) + "</latencyBudget>" +
                    Kind("data_sharing", "OFF");
  if (drawn.without_acks) {
    qos += "<disablePositiveAcks><enabled>true</enabled></disablePositiveAcks>";
  }
  return "<" + element + " profile_name=\"" + name + "\"><qos>" + qos + "</qos></" + element +
         ">\n";
}

}  // namespace

std::string RandomPair(const std::string& name, Random* random) {
  Dice dice(random);
  const Drawn writer = Draw(&dice);
  Drawn reader = Like(writer, &dice);
  Drawn safe = writer;
  // Fast DDS 2.9.1 crashes where a writer without acknowledgements meets a best-effort reader.
  if (reader.reliability == 0) safe.without_acks = reader.without_acks = false;
  return Profile("data_writer", name + "_writer", safe) +
         Profile("data_reader", name + "_reader", reader);
}

std::string RandomLimits(const std::string& name, Random* random) {
  Dice dice(random);
  constexpr std::array kLimits = {0, 1, 4, 20, 100, 400};
  std::string profiles;
  for (const std::string side : {"writer", "reader"}) {
    const auto limit = [&](const std::string& element) {
      if (dice.OneIn(4)) return std::string();
      return "<" + element + ">" + std::to_string(dice.OneOf(kLimits)) + "</" + element + ">";
    };
    std::string liveliness;
    if (dice.OneIn(2)) {
      liveliness = "<liveliness><kind>" + std::string(dice.OneOf(kLivelinesses)) + "</kind>" +
                   Duration("lease_duration", dice.OneOf(kMilliseconds)) +
                   Duration("announcement_period", dice.OneOf(kMilliseconds)) + "</liveliness>";
    }
    profiles += "<data_" + side + " profile_name=\"" + name + "_" + side +
                "\"><topic><resourceLimitsQos>" + limit("max_samples") + limit("max_instances") +
                limit("max_samples_per_instance") + "</resourceLimitsQos></topic><qos>" +
                Kind("durability", dice.OneIn(4) ? dice.OneOf(kDurabilities) : "TRANSIENT_LOCAL") +
                liveliness + "</qos></data_" + side + ">\n";
  }
  return profiles;
}

std::string AsFile(const std::string& profiles) {
  return "<dds><profiles>\n" + profiles + "</profiles></dds>\n";
}

}  // namespace giveway::test
