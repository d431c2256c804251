#include "services/observer/server/page_server.h"

#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstring>
#include <functional>
#include <optional>
#include <thread>
#include <utility>

#include "services/observer/server/client_stream.h"
#include "services/observer/server/pending_requests.h"
#include "services/observer/server/request_rules.h"
#include "services/runtime/process.h"
#include "services/runtime/signals_blocked.h"

namespace giveway {
namespace {

using std::chrono::milliseconds;

// One a stream, and some for the page and for programs.
constexpr std::size_t kThreads = PageServer::kMostStreams + 4;
constexpr int kMostWaiting = 16;  // requests; the connections of further ones are closed
constexpr Nanoseconds kHeartbeat = std::chrono::seconds(1);  // of a stream without frames

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

class StreamServer : public httplib::Server {
 public:
  StreamServer() {
    const SignalsBlocked blocked;
    pool_.emplace(kThreads);
    pending_.emplace([this](int socket) { HandOn(socket); });
  }
  ~StreamServer() override { Finish(); }
  StreamServer(const StreamServer&) = delete;
  StreamServer& operator=(const StreamServer&) = delete;

  void GiveUp() { stops_ = true; }
  bool GivesUp() const { return stops_; }
  // No client is answered from here on. To be called once it has given up and accepts no more.
  void Finish() {
    pending_.reset();
    if (pool_) pool_->shutdown();
    pool_.reset();
  }

 private:
  bool process_and_close_socket(socket_t socket) override {
    pending_->Take(socket);
    return true;
  }

  void HandOn(int socket) {
    if (waiting_ >= kMostWaiting) {
      close(socket);
      return;
    }
    ++waiting_;
    pool_->enqueue([this, socket] {
      --waiting_;
      ClientStream stream(socket, stops_);
      Answer(*this, stream);
      stream.Drain();
      close(socket);
    });
  }

  // A template: later versions of the library want the addresses handed in, 0.11 does not.
  template <typename Server>
  static void Answer(Server& server, ClientStream& stream) {
    bool closed = false;
    if constexpr (requires { server.process_request(stream, true, closed, nullptr); }) {
      server.process_request(stream, true, closed, nullptr);
    } else {
      server.process_request(stream, "", 0, "", 0, true, closed, nullptr);
    }
  }

  std::atomic<bool> stops_{false};
  std::atomic<int> waiting_{0};  // requests that wait for a thread
  std::optional<httplib::ThreadPool> pool_;
  std::optional<PendingRequests> pending_;  // hands on to the pool
};

void ListenAlone(socket_t socket) {
  const int yes = 1;
  setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof(yes));
}

std::string AsEvent(std::string_view name, std::string_view data) {
  std::string text = "event: ";
  text += name;
  text += "\ndata: ";
  text += data;
  return text + "\n\n";
}

void Refuse(int status, const std::string& why, httplib::Response& response) {
  response.status = status;
  response.set_content(why + "\n", "text/plain; charset=utf-8");
}

}  // namespace

struct PageServer::Impl {
  explicit Impl(PageSources from) : sources(std::move(from)) {}

  PageSources sources;
  StreamServer server;
  std::atomic<int> streams{0};
  std::atomic<std::uint64_t> refused{0};
  std::atomic<bool> ended{false};
  std::thread listener;

  ServerFigures Figures() const { return {streams, refused}; }

  // Before the library's own routing, which matches paths by regular expressions.
  void Answer(const httplib::Request& request, httplib::Response& response) {
    constexpr int kNotAllowed = 405;
    constexpr int kNoRanges = 416;
    constexpr int kMisdirected = 421;
    if (request.method != "GET" && request.method != "HEAD") {
      response.set_header("Allow", "GET, HEAD");
      Refuse(kNotAllowed, "only GET: this server is read-only", response);
    } else if (!IsOwnHost(request.get_header_value("Host"), sources.host_names)) {
      Refuse(kMisdirected,
             "the Host header names neither an address nor localhost; --host-name allows a name",
             response);
    } else if (request.has_header("Range")) {
      Refuse(kNoRanges, "nothing here is served in parts", response);
    } else {
      Get(request, response);
      return;
    }
    ++refused;
  }

  void Stream(httplib::Response& response) {
    constexpr int kBusy = 503;
    if (streams.fetch_add(1) >= kMostStreams) {
      --streams;
      ++refused;
      Refuse(kBusy, "16 clients follow already; close one of them", response);
      return;
    }
    response.set_header("Cache-Control", "no-store");
    response.set_chunked_content_provider(
        "text/event-stream",
        [this, after = sources.frames->Number()](std::size_t offset,
                                                 httplib::DataSink& sink) mutable {
          return WriteNext(offset == 0, &after, sink);
        },
        [this](auto&&...) { --streams; });
  }

  // False ends the stream.
  bool WriteNext(bool first, std::uint64_t* after, httplib::DataSink& sink) {
    if (server.GivesUp() || sources.frames->IsClosed()) return false;
    if (first) {
      const std::string scene = AsEvent("scene", sources.scene);
      return sink.write(scene.data(), scene.size());
    }
    const auto [frame, number] = sources.frames->Wait(*after, kHeartbeat);
    const std::string text = frame ? AsEvent("frame", *frame) : ": nothing new\n\n";
    *after = number;
    return sink.write(text.data(), text.size());
  }

  void Get(const httplib::Request& request, httplib::Response& response) {
    if (request.path == "/") {
      response.set_header("Content-Security-Policy",
                          "default-src 'none'; script-src 'unsafe-inline'; style-src "
                          "'unsafe-inline'; connect-src 'self'; img-src data:; "
                          "frame-ancestors 'none'; base-uri 'none'; form-action 'none'");
      response.set_header("X-Content-Type-Options", "nosniff");
      // From where it is: a run's page may have 100 MB.
      response.set_content_provider(
          sources.page.size(), "text/html; charset=utf-8",
          [this](std::size_t offset, std::size_t length, httplib::DataSink& sink) {
            return sink.write(sources.page.data() + offset, length);
          });
      return;
    }
    if (request.path == "/api/v1/stream" && sources.frames != nullptr) return Stream(response);
    auto answer = sources.get(request.path, Figures());
    if (!answer) {
      constexpr int kNotFound = 404;
      Refuse(kNotFound,
             "there is /, /api/v1/fleet, /api/v1/vehicles/ID, /api/v1/events, /api/v1/stream, "
             "/metrics, /livez and /readyz",
             response);
      return;
    }
    response.status = answer->status;
    response.set_header("Cache-Control", "no-store");
    response.set_content(answer->body, answer->type);
  }

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

PageServer::PageServer(const std::string& address, std::uint16_t port, PageSources sources)
    : impl_(std::make_unique<Impl>(std::move(sources))) {
  StreamServer& server = impl_->server;
  server.set_socket_options(ListenAlone);
  server.new_task_queue = [] { return new AtOnce; };
  server.set_pre_routing_handler([this](const auto& request, auto& response) {
    impl_->Answer(request, response);
    return httplib::Server::HandlerResponse::Handled;
  });
  errno = 0;
  if (!server.bind_to_port(address, port)) {
    throw ServerError("cannot listen on " + address + " port " + std::to_string(port) + ": " +
                      (errno != 0 ? std::strerror(errno) : "not an address of this host") +
                      "; choose another --port or --address");
  }
  const SignalsBlocked blocked;  // one that met the thread that accepts would end the server
  impl_->listener = std::thread([this, address, port] { impl_->Listen(address, port); });
}

PageServer::~PageServer() {
  impl_->server.GiveUp();
  // A stop that comes before the library's loop runs is lost: repeated until it is over.
  while (!impl_->ended) {
    impl_->server.stop();
    SleepUntil(SteadyNow() + milliseconds(5));
  }
  impl_->listener.join();
  impl_->server.Finish();  // its clients use what else there is
}

ServerFigures PageServer::Figures() const { return impl_->Figures(); }

}  // namespace giveway
