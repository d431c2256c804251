// One connection of the page server, bounded: the library reads a line for as long as a client
// sends it, and waits for a slow client without limit. Here size and time of a request are limited,
// and a write that makes no progress ends the connection.
#pragma once

#include <httplib.h>

#include <atomic>
#include <cstddef>
#include <string>

#include "services/types/time.h"

namespace giveway {

class ClientStream : public httplib::Stream {
 public:
  ClientStream(int socket, const std::atomic<bool>& stops);

  // Without `override`: which of these its base declares depends on the library's version.
  virtual bool is_readable() const;
  virtual bool is_writable() const;
  virtual bool wait_readable() const { return is_readable(); }
  virtual bool wait_writable() const { return is_writable(); }
  virtual time_t duration() const { return 0; }
  virtual ssize_t read(char* to, std::size_t size);
  virtual ssize_t write(const char* from, std::size_t size);
  virtual void get_remote_ip_and_port(std::string& /*ip*/, int& port) const { port = 0; }
  virtual void get_local_ip_and_port(std::string& /*ip*/, int& port) const { port = 0; }
  virtual socket_t socket() const { return socket_; }

  // Lets the client take what was sent: closing over unread bytes would take it back.
  void Drain();

 private:
  bool Wait(short what, SteadyTime until) const;

  const int socket_;
  const std::atomic<bool>& stops_;
  const SteadyTime read_until_;
  std::size_t taken_ = 0;
};

}  // namespace giveway
