#include "services/fleetctl/why/why_probe.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sched.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <functional>
#include <sstream>
#include <stdexcept>

#include "services/fleetctl/args/qos_files.h"
#include "services/fleetctl/process/file_descriptor.h"
#include "services/fleetctl/process/run_in_child.h"
#include "services/link/discovery_probe.h"
#include "services/link/observer_link.h"
#include "services/runtime/process.h"

namespace giveway::fleetctl {
namespace {

constexpr Nanoseconds kTurn = std::chrono::milliseconds(5);
// A vehicle publishes its status five times a second, and may lag a little behind the probe.
constexpr double kReceiverReportSeconds = 2.5;
constexpr double kRunTimeMs = 2000;
constexpr Nanoseconds kNamesTime = std::chrono::seconds(2);

[[noreturn]] void Throw(const std::string& what) {
  throw std::runtime_error(what + ": " + std::strerror(errno));
}

// A namespace to enter, opened before any is entered: /proc looks different from inside.
class Namespace {
 public:
  Namespace(int pid, const char* kind, int type, std::optional<std::uint64_t> theirs)
      : kind_(kind), type_(type) {
    const std::string own = fmt::format("/proc/self/ns/{}", kind);
    char link[64] = {};
    const ssize_t length = readlink(own.c_str(), link, sizeof(link) - 1);
    if (!theirs || (length > 0 && link == fmt::format("{}:[{}]", kind, *theirs))) return;
    fd_ = FileDescriptor(open(fmt::format("/proc/{}/ns/{}", pid, kind).c_str(), O_RDONLY));
    if (!fd_.IsOpen()) Throw(fmt::format("cannot open its {} namespace", kind));
  }
  bool IsOther() const { return fd_.IsOpen(); }
  void Enter() const {
    if (IsOther() && setns(fd_.Get(), type_) != 0) {
      Throw(fmt::format("cannot enter its {} namespace", kind_));
    }
  }

 private:
  const char* kind_;
  int type_;
  FileDescriptor fd_;
};

void TakePlace(const ProcessSituation& hearer) {
  if (!hearer.network_namespace) throw std::runtime_error("its network namespace is not known");
  const Namespace network(hearer.pid, "net", CLONE_NEWNET, hearer.network_namespace);
  const Namespace mounts(hearer.pid, "mnt", CLONE_NEWNS, hearer.mount_namespace);
  network.Enter();
  mounts.Enter();
}

link::LinkOptions OptionsOf(const LaunchOptions& launch) {
  link::LinkOptions options;
  options.domain = launch.domain;
  options.interface = launch.interface;
  options.qos = ReadSoundQos(launch.qos_file);
  options.area = launch.area;
  options.fleet_size = launch.fleet_size;
  options.discovery_servers = launch.discovery_servers;
  options.leaves_out_shared_memory = launch.leaves_out_shared_memory;
  return options;
}

std::vector<link::ProbeTopic> ProbeTopics(const std::vector<TopicOutlook>& topics) {
  std::vector<link::ProbeTopic> all;
  for (const TopicOutlook& topic : topics) all.push_back({topic.topic, topic.read_in});
  return all;
}

class Probing {
 public:
  explicit Probing(const ProbeOrder& order)
      : order_(order), observer_(OptionsOf(order.hearer.launch)), since_(SteadyNow()) {
    // Blackouts count from the start of the run: the world publishes how long ago that was.
    while (HasBlackouts() && !run_began_ && SinceMs() < kRunTimeMs) {
      SleepUntil(SteadyNow() + kTurn);
      NoteReceiverReport(observer_.Take());
    }
    probe_.emplace(Impaired(order.hearer.launch), ProbeTopics(order.topics),
                   order.hearer.launch.id);
    if (run_began_) probe_->StartImpairment(*run_began_);
  }

  ProbeResult Run() {
    while (!IsOver()) {
      SleepUntil(SteadyNow() + kTurn);
      processes_ = probe_->Poll();
      for (const link::ProbedProcess& process : processes_) {
        if (IsSpeaker(process)) Note(process);
        if (IsHearer(process)) NoteHearer(process);
      }
      for (const TopicOutlook& topic : order_.topics) NoteFit(topic.topic);
      for (std::string& line : probe_->TakeUnfit(SteadyNow())) {
        result_.unfit.push_back(std::move(line));
      }
      NoteReceiverReport(observer_.Take());
    }
    result_.listened_ms = SinceMs();
    return std::move(result_);
  }

 private:
  static link::LinkOptions Impaired(const LaunchOptions& launch) {
    link::LinkOptions options = OptionsOf(launch);
    options.impairment = launch.impairment;
    return options;
  }
  bool HasBlackouts() const {
    return std::ranges::any_of(order_.hearer.launch.impairment.rules,
                               [](const ImpairmentRule& rule) {
                                 return !rule.blackouts.empty() || rule.from_s || rule.to_s;
                               });
  }
  double SinceMs() const { return Seconds(SteadyNow() - since_) * 1e3; }

  bool IsOver() const {
    const double seconds = SinceMs() * 1e-3;
    if (seconds >= order_.seconds) return true;
    const bool all = std::ranges::all_of(order_.topics, [&](const TopicOutlook& topic) {
      const auto found = result_.topics.find(topic.topic);
      return found != result_.topics.end() && found->second.samples > 0;
    });
    // Of a hearer elsewhere discovery is all there is to judge by.
    const bool enough = order_.hearer_here && seconds >= kReceiverReportSeconds;
    return all && (ReceiverReportFits() || enough);
  }
  // Whether discovery has reported the readers of a hearer that does not answer.
  bool HasFits() const {
    return std::ranges::all_of(order_.topics, [&](const TopicOutlook& topic) {
      const auto found = result_.topics.find(topic.topic);
      return found != result_.topics.end() && (found->second.fits || !found->second.unfit.empty());
    });
  }
  // By what discovery reports of the two themselves.
  void NoteFit(const std::string& topic) {
    ProbedTopic& probed = result_.topics[topic];
    for (const link::ProbedProcess& speaker : processes_) {
      for (const link::ProbedProcess& hearer : processes_) {
        if (!IsSpeaker(speaker) || !IsHearer(hearer)) continue;
        for (const link::FoundEndpoint& writer : speaker.endpoints) {
          for (const link::FoundEndpoint& reader : hearer.endpoints) {
            if (writer.topic != topic || reader.topic != topic) continue;
            if (writer.writes && !reader.writes) NoteFit(writer, reader, &probed);
          }
        }
      }
    }
  }
  static void NoteFit(const link::FoundEndpoint& writer, const link::FoundEndpoint& reader,
                      ProbedTopic* probed) {
    const std::string unfit = link::PartitionsMatch(writer, reader)
                                  ? link::Misfit(writer, reader)
                                  : "partition: written in " + link::PartitionText(writer) +
                                        ", read in " + link::PartitionText(reader);
    probed->fits |= unfit.empty();
    probed->unfit = probed->fits ? "" : unfit;
  }

  // It published a status, and one of a hearer of beacons says that it took some; else it gets more
  // time.
  bool ReceiverReportFits() const {
    if (!order_.hearer_here) return HasFits();
    if (order_.hearer.launch.is_world) return true;
    return result_.receiver_report &&
           (order_.speaker.launch.is_world || result_.receiver_report->taken > 0);
  }

  // In containers every service is process 1: if both ids are known they must be the same.
  static bool MayBe(const ProcessSituation& meant, const link::ProbedProcess& process) {
    return meant.launch.id == kNoVehicle || process.vehicle == kNoVehicle ||
           meant.launch.id == process.vehicle;
  }
  static bool Is(const ProcessSituation& meant, const link::ProbedProcess& process) {
    if (!meant.participant.empty()) {
      return meant.participant == link::ParticipantText(process.guid);
    }
    if (!MayBe(meant, process)) return false;
    if (meant.pid_inside != 0) {
      return process.process == static_cast<std::uint16_t>(meant.pid_inside);
    }
    if (!meant.launch.is_world) return process.vehicle == meant.launch.id;
    return std::ranges::find(process.partitions, "world") != process.partitions.end();
  }
  bool IsSpeaker(const link::ProbedProcess& process) const { return Is(order_.speaker, process); }
  bool IsHearer(const link::ProbedProcess& process) const { return Is(order_.hearer, process); }
  static std::string ForeignVendor(const link::ProbedProcess& process) {
    return link::IsOurVendor(process.guid) ? "" : link::VendorOf(process.guid);
  }
  void NoteHearer(const link::ProbedProcess& process) {
    result_.hearer_discovered = true;
    result_.hearer_foreign = ForeignVendor(process);
    result_.hearer_joined |= process.vehicle != kNoVehicle;
  }

  void Note(const link::ProbedProcess& process) {
    result_.discovered = true;
    result_.joined |= process.vehicle != kNoVehicle;
    result_.host_id = process.host_id;
    result_.speaker_foreign = ForeignVendor(process);
    for (const auto& [name, count] : process.topics) {
      ProbedTopic& topic = result_.topics[name];
      topic.matched |= count.matched;
      topic.samples = std::max(topic.samples, count.samples);
      if (topic.samples > 0 && !topic.first_ms) topic.first_ms = SinceMs();
    }
  }

  void NoteReceiverReport(const link::Observed& observed) {
    for (const VehicleStatus& status : observed.statuses) {
      if (order_.hearer.launch.id == kNoVehicle || status.vehicle != order_.hearer.launch.id)
        continue;
      result_.receiver_report = ReceiverReport{
          status.peers_heard,       status.beacons.taken,      status.beacons.accepted,
          status.beacons.not_heard, status.beacons.Rejected(), status.qos.incompatible_qos};
    }
    for (const Truth& truth : observed.truths) {
      if (truth.time_s < 0) continue;
      run_began_ = SteadyNow() - Nanoseconds(static_cast<std::int64_t>(truth.time_s * 1e9));
    }
  }

  const ProbeOrder& order_;
  link::ObserverLink observer_;
  const SteadyTime since_;
  std::optional<SteadyTime> run_began_;
  std::optional<link::DiscoveryProbe> probe_;
  std::vector<link::ProbedProcess> processes_;
  ProbeResult result_;
};

// One fact per line; the first word says which.
std::string Written(const ProbeResult& result) {
  std::string text = fmt::format("listened {}\n", result.listened_ms);
  if (result.discovered) {
    text += fmt::format("found {} {}\n", result.joined ? 1 : 0, result.host_id.value_or(0));
  }
  if (result.hearer_discovered) {
    text += fmt::format("hearer {}\n", result.hearer_joined ? 1 : 0);
  }
  for (const auto& [name, topic] : result.topics) {
    text += fmt::format("topic {} {} {} {}\n", name, topic.matched ? 1 : 0, topic.samples,
                        topic.first_ms.value_or(-1));
  }
  for (const auto& [name, topic] : result.topics) {
    if (topic.fits) text += fmt::format("fits {}\n", name);
    if (!topic.unfit.empty()) text += fmt::format("misfit {} {}\n", name, topic.unfit);
  }
  for (const std::string& line : result.unfit) text += fmt::format("unfit {}\n", line);
  if (!result.hearer_foreign.empty()) {
    text += fmt::format("hearer_foreign {}\n", result.hearer_foreign);
  }
  if (!result.speaker_foreign.empty()) {
    text += fmt::format("speaker_foreign {}\n", result.speaker_foreign);
  }
  if (const auto& word = result.receiver_report) {
    text += fmt::format("word {} {} {} {} {} {}\n", word->peers_heard, word->taken, word->accepted,
                        word->too_far, word->rejected, word->incompatible);
  }
  return text;
}

ProbeResult Understood(const std::string& text) {
  ProbeResult result;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string kind;
    words >> kind;
    if (kind == "listened") words >> result.listened_ms;
    if (kind == "found") {
      result.discovered = bool(words >> result.joined >> result.host_id.emplace());
    }
    if (kind == "hearer") result.hearer_discovered = bool(words >> result.hearer_joined);
    if (kind == "trouble") std::getline(words >> std::ws, result.trouble);
    const auto rest = [&words] {
      std::string line_end;
      std::getline(words >> std::ws, line_end);
      return line_end;
    };
    std::string of;
    if (kind == "fits" && words >> of) result.topics[of].fits = true;
    if (kind == "misfit" && words >> of) result.topics[of].unfit = rest();
    if (kind == "unfit") result.unfit.push_back(rest());
    if (kind == "hearer_foreign") result.hearer_foreign = rest();
    if (kind == "speaker_foreign") result.speaker_foreign = rest();
    if (kind == "topic") {
      std::string name;
      ProbedTopic topic;
      double first_ms = -1;
      words >> name >> topic.matched >> topic.samples >> first_ms;
      if (first_ms >= 0) topic.first_ms = first_ms;
      result.topics[name] = topic;
    }
    if (kind == "word") {
      ReceiverReport& word = result.receiver_report.emplace();
      words >> word.peers_heard >> word.taken >> word.accepted >> word.too_far >> word.rejected >>
          word.incompatible;
    }
  }
  return result;
}

// The name each process gives itself, by the low half of its process id.
std::string NamesHeard(const LaunchOptions& launch, std::set<std::uint16_t> wanted) {
  link::DiscoveryProbe probe(OptionsOf(launch), {}, kNoVehicle);
  std::string text;
  for (const SteadyTime end = SteadyNow() + kNamesTime; SteadyNow() < end && !wanted.empty();) {
    SleepUntil(SteadyNow() + kTurn);
    text.clear();
    for (const link::ProbedProcess& process : probe.Poll()) {
      if (process.vehicle == kNoVehicle) continue;
      wanted.erase(process.process);
      text += fmt::format("name {} {}\n", process.process, Number(process.vehicle));
    }
  }
  return text;
}

// What `listen` reports from a child process in the place of another; "trouble WHY" if it could
// not.
std::string InPlaceOf(const ProcessSituation& process, const std::function<std::string()>& listen) {
  const auto in_its_place = [&] {
    try {
      TakePlace(process);
      return listen();
    } catch (const std::exception& error) {
      std::string text = std::string("trouble ") + error.what();
      std::ranges::replace(text, '\n', ' ');
      return text;
    }
  };
  return RunInChild(in_its_place).text;
}

}  // namespace

ProbeResult Probe(const ProbeOrder& order) {
  const std::string text =
      InPlaceOf(order.hearer, [&order] { return Written(Probing(order).Run()); });
  ProbeResult result = Understood(text);
  if (text.empty()) result.trouble = "the probing process ended without a word";
  return result;
}

std::map<std::uint16_t, VehicleId> ListenForNames(const ProcessSituation& place,
                                                  const std::set<std::uint16_t>& wanted) {
  std::map<std::uint16_t, VehicleId> names;
  std::istringstream words(InPlaceOf(place, [&] { return NamesHeard(place.launch, wanted); }));
  std::string kind;
  std::uint16_t process = 0;
  std::uint32_t id = 0;
  while (words >> kind >> process >> id) names[process] = VehicleId{id};
  return names;
}

}  // namespace giveway::fleetctl
