// Packets that are late on purpose: keeps copies and hands each to the library when it is due. One
// thread, asleep until then.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <map>
#include <mutex>
#include <thread>
#include <vector>

#include "services/link/fastdds/fastdds_version.h"

namespace giveway::link {

struct LatePacket {
  std::vector<rtps::octet> bytes;
  transport::TransportReceiverInterface* receiver = nullptr;  // lives until Forget of its port
  rtps::Locator_t local;
  rtps::Locator_t remote;

  void HandOn() const;
};

class DelayLine {
 public:
  using Time = std::chrono::steady_clock::time_point;

  DelayLine();
  ~DelayLine();  // packets in flight are lost
  DelayLine(const DelayLine&) = delete;
  DelayLine& operator=(const DelayLine&) = delete;

  // False if too many are in flight; then the packet is lost. Of packets due at once the first
  // pushed is delivered first.
  bool Push(Time due, LatePacket packet);
  // Loses the packets in flight to a local port; none is handed on there once this returns. Gives
  // how many were lost.
  std::size_t Forget(std::uint32_t local_port);

 private:
  void Run();

  std::mutex mutex_;  // guards all that follows but the thread
  std::condition_variable woken_;
  std::condition_variable idle_;
  std::multimap<Time, LatePacket> waiting_;
  bool handing_on_ = false;
  bool stopping_ = false;
  std::thread thread_;  // last: it uses the others
};

}  // namespace giveway::link
