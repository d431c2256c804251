#include "services/health/health_server.h"

#include <httplib.h>
#include <sys/socket.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <exception>
#include <string_view>
#include <thread>
#include <utility>

#include "services/config/problem.h"
#include "services/health/connection_desk.h"
#include "services/runtime/process.h"
#include "services/runtime/signals_blocked.h"

namespace giveway {
namespace {

using std::chrono::milliseconds;

constexpr time_t kClientPatience_s = 4;  // longer than others can hold its place

constexpr int kNo = 1;
constexpr int kNoAnswer = 2;

// A request that has come whole, and the socket for its answer, which the system takes whole or not
// at all: pages are some kilobytes.
class WholeRequest : public httplib::Stream {
 public:
  WholeRequest(int socket, const std::string& request) : socket_(socket), request_(request) {}

  // Without `override`: which of these its base declares depends on the library's version.
  virtual bool is_readable() const { return taken_ < request_.size(); }
  virtual bool is_writable() const { return true; }
  virtual bool wait_readable() const { return is_readable(); }
  virtual bool wait_writable() const { return true; }
  virtual time_t duration() const { return 0; }
  virtual ssize_t read(char* to, size_t size) {
    const std::size_t most = std::min(size, request_.size() - taken_);
    if (most == 0) return -1;
    std::copy_n(request_.begin() + static_cast<std::ptrdiff_t>(taken_), most, to);
    taken_ += most;
    return static_cast<ssize_t>(most);
  }
  virtual ssize_t write(const char* from, size_t size) {
    return send(socket_, from, size, MSG_NOSIGNAL);
  }
  virtual void get_remote_ip_and_port(std::string& /*ip*/, int& port) const { port = 0; }
  virtual void get_local_ip_and_port(std::string& /*ip*/, int& port) const { port = 0; }
  virtual socket_t socket() const { return socket_; }

 private:
  const int socket_;
  const std::string& request_;
  std::size_t taken_ = 0;
};

// Runs tasks at once, on the thread that accepts: all they do is to hand over a connection.
class AtOnce : public httplib::TaskQueue {
  // Later versions of the library say whether they took a task.
  using Taken = decltype(std::declval<httplib::TaskQueue&>().enqueue({}));

 public:
  Taken enqueue(std::function<void()> task) override {
    task();
    return static_cast<Taken>(true);
  }
  void shutdown() override {}
};

class DeskServer : public httplib::Server {
 public:
  void GiveUp() { stops_ = true; }
  bool GivesUp() const { return stops_; }

 private:
  bool process_and_close_socket(socket_t socket) override {
    desk_.Take(socket);
    return true;
  }

  // A template: later versions of the library want the addresses handed in, 0.11 does not.
  template <typename Server>
  static void Answer(Server& server, WholeRequest& stream) {
    bool closed = false;
    if constexpr (requires { server.process_request(stream, true, closed, nullptr); }) {
      server.process_request(stream, true, closed, nullptr);
    } else {
      server.process_request(stream, "", 0, "", 0, true, closed, nullptr);
    }
  }

  std::atomic<bool> stops_{false};
  ConnectionDesk desk_{[this](int socket, const std::string& request) {
    WholeRequest stream(socket, request);
    Answer(*this, stream);
  }};
};

bool WantsJson(const httplib::Request& request) {
  return request.get_param_value("format") == "json" ||
         request.get_header_value("Accept").find("application/json") != std::string::npos;
}

void Respond(const char* what, const Reasons& reasons, const httplib::Request& request,
             httplib::Response& response) {
  constexpr int kUnavailable = 503;
  if (!reasons.empty()) response.status = kUnavailable;
  if (WantsJson(request)) {
    response.set_content(AsJson(what, reasons), "application/json");
  } else {
    response.set_content(AsText(what, reasons), "text/plain; charset=utf-8");
  }
}

httplib::Server::HandlerResponse OnlyGet(const httplib::Request& request,
                                         httplib::Response& response) {
  constexpr int kNotAllowed = 405;
  if (request.method == "GET" || request.method == "HEAD") {
    return httplib::Server::HandlerResponse::Unhandled;
  }
  response.status = kNotAllowed;
  response.set_header("Allow", "GET, HEAD");
  return httplib::Server::HandlerResponse::Handled;
}

void Route(httplib::Server& server, const HealthPages& pages) {
  server.set_pre_routing_handler(OnlyGet);
  server.Get("/livez", [live = pages.not_live](const auto& request, auto& response) {
    Respond("live", live(), request, response);
  });
  server.Get("/readyz", [ready = pages.not_ready](const auto& request, auto& response) {
    Respond("ready", ready(), request, response);
  });
  server.Get("/metrics", [metrics = pages.metrics](const auto& /*request*/, auto& response) {
    response.set_content(metrics(), "text/plain; version=0.0.4; charset=utf-8");
  });
  server.set_error_handler([](const httplib::Request& /*request*/, httplib::Response& response) {
    constexpr int kNotFound = 404;
    if (response.status != kNotFound) return;
    response.set_content("there is /livez, /readyz and /metrics\n", "text/plain");
  });
}

// Without the library's SO_REUSEPORT, by which two vehicles would share a port in turns. With
// SO_REUSEADDR a port is free again as soon as its process is gone.
void OnlyOneListens(socket_t socket) {
  const int yes = 1;
  setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof(yes));
}

// Of a service that listens on every address.
std::string Reachable(const std::string& address) {
  if (address == "0.0.0.0") return "127.0.0.1";
  return address == "::" ? "::1" : address;
}

}  // namespace

struct HealthServer::Impl {
  DeskServer server;
  std::atomic<bool> ended{false};
  std::thread listener;

  // A momentary network failure ends the library's loop; then it starts again.
  void Listen(const std::string& address, std::uint16_t port) {
    while (!server.GivesUp()) {
      server.listen_after_bind();
      while (!server.GivesUp() && !server.bind_to_port(address, port)) {
        SleepUntil(SteadyNow() + milliseconds(100));
      }
    }
    ended = true;
  }
};

HealthServer::HealthServer(const std::string& address, std::uint16_t port, const HealthPages& pages)
    : impl_(std::make_unique<Impl>()) {
  DeskServer& server = impl_->server;
  server.set_socket_options(OnlyOneListens);
  server.new_task_queue = [] { return new AtOnce; };
  Route(server, pages);
  errno = 0;
  if (!server.bind_to_port(address, port)) {
    const int why = errno;
    throw InputError({{.file = "command line or environment",
                       .field = "--health-port",
                       .value = std::to_string(port),
                       .message = "cannot listen on " + address +
                                  (why == 0 ? "" : std::string(": ") + std::strerror(why)),
                       .remedy = why == EADDRINUSE ? "give each service of a host a port of its own"
                                                   : "check --health-address and --health-port"}});
  }
  const SignalsBlocked blocked;  // one that met the thread that accepts would end the server
  impl_->listener = std::thread(&Impl::Listen, impl_.get(), address, port);
}

HealthServer::~HealthServer() {
  impl_->server.GiveUp();
  while (!impl_->ended) {  // the library forgets a stop that comes before it listens
    impl_->server.stop();
    SleepUntil(SteadyNow() + milliseconds(1));
  }
  impl_->listener.join();
}

int AskHealth(const std::string& address, std::uint16_t port, const std::string& what) {
  constexpr int kOk = 200;
  const std::string host = Reachable(address);
  httplib::Client client(host, port);
  client.set_connection_timeout(kClientPatience_s);
  client.set_read_timeout(kClientPatience_s);
  const std::string path = what == "metrics" ? "/metrics" : "/" + what + "z";
  const httplib::Result answer = client.Get(path.c_str());
  if (!answer) {
    std::fprintf(stderr, "no answer on %s:%u: is the service running, with this port?\n",
                 host.c_str(), static_cast<unsigned>(port));
    return kNoAnswer;
  }
  std::fwrite(answer->body.data(), 1, answer->body.size(), stdout);
  return answer->status == kOk && std::fflush(stdout) == 0 ? 0 : kNo;
}

}  // namespace giveway
