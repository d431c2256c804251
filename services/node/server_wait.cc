#include "services/node/server_wait.h"

#include <chrono>
#include <future>
#include <string>
#include <system_error>
#include <thread>
#include <utility>

#include "services/link/fastdds/server_addresses.h"

namespace giveway {
namespace {

constexpr auto kPoll = std::chrono::milliseconds(20);
constexpr Nanoseconds kAskAgain = std::chrono::seconds(1);
constexpr Nanoseconds kReminder = std::chrono::seconds(30);

std::future<link::FoundServers> NotAsked(const std::string& why) {
  std::promise<link::FoundServers> answer;
  answer.set_value({.addresses = {}, .fault = "cannot look up its discovery servers now: " + why});
  return answer.get_future();
}

// On a thread that is not joined: a lookup without a name server takes seconds, and a stop takes
// one at most.
std::future<link::FoundServers> Ask(const std::vector<DiscoveryServer>& servers) {
  std::packaged_task<link::FoundServers()> task([servers] { return link::FindServers(servers); });
  auto answer = task.get_future();
  try {
    std::thread(std::move(task)).detach();
  } catch (const std::system_error& error) {  // too many threads just now
    return NotAsked(error.what());
  }
  return answer;
}

}  // namespace

std::optional<std::vector<link::ServerAddress>> AwaitServers(
    const link::LinkOptions& options, const StopSignal& stop,
    const std::function<void(const std::string& why)>& tell) {
  if (options.discovery_servers.empty()) return std::vector<link::ServerAddress>{};
  std::string why = "looks up its discovery servers: " + ToText(options.discovery_servers);
  SteadyTime remind{0};
  SteadyTime again{0};
  std::future<link::FoundServers> answer;
  while (!stop.IsSet()) {
    tell(why);
    if (!answer.valid() && SteadyNow() >= again) answer = Ask(options.discovery_servers);
    if (!answer.valid() || answer.wait_for(kPoll) != std::future_status::ready) {
      SleepUntil(SteadyNow() + kPoll);
      continue;
    }
    const link::FoundServers found = answer.get();
    if (found.fault.empty()) {
      tell("");
      return found.addresses;
    }
    why = found.fault;
    again = SteadyNow() + kAskAgain;
    if (SteadyNow() < remind) continue;
    LogWarning(why);
    remind = SteadyNow() + kReminder;
  }
  return std::nullopt;
}

}  // namespace giveway
