#include "services/observer/foxglove/foxglove_server.h"

#include <atomic>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <chrono>
#include <deque>
#include <optional>
#include <set>
#include <thread>
#include <utility>

#include "services/observer/foxglove/newest_samples.h"
#include "services/observer/server/page_server.h"
#include "services/observer/server/request_rules.h"
#include "services/observer/server/socket_bounds.h"
#include "services/runtime/process.h"
#include "services/runtime/signals_blocked.h"

namespace giveway {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = boost::beast::http;
namespace websocket = boost::beast::websocket;
using asio::ip::tcp;
using boost::system::error_code;

constexpr std::size_t kMostConnections = 32;     // also those that have not said what they want
constexpr std::size_t kLongestHandshake = 8192;  // bytes: a browser sends some hundred
constexpr std::size_t kLongestMessage = 64UL << 10U;
constexpr std::size_t kMostTexts = 64;  // answers that wait for a client
constexpr std::chrono::seconds kHandshakeTime{5};
constexpr std::chrono::seconds kWriteTime{10};  // one message, to a client that takes some of it
constexpr std::chrono::seconds kIdleTime{30};   // half of it, and a client is pinged

// Of a browser, which page asks; its protocol is no matter. Foxglove's own page is what this port
// is for; its desktop program shows a file.
bool IsAllowedOrigin(std::string_view origin, const std::vector<std::string>& host_names) {
  if (origin.empty() || origin == "https://app.foxglove.dev" || origin == "file://") return true;
  const std::size_t scheme = origin.find("://");
  return scheme != std::string_view::npos && IsOwnHost(origin.substr(scheme + 3), host_names);
}

std::string_view View(beast::string_view text) { return {text.data(), text.size()}; }

struct RefusedUpgrade {
  http::status status = http::status::bad_request;
  std::string why;
};

// What a connection asks for, checked before it becomes a client.
using Handshake = http::request<http::empty_body>;
std::optional<RefusedUpgrade> RefusalOf(const Handshake& request,
                                        const std::vector<std::string>& hosts) {
  if (!IsOwnHost(View(request[http::field::host]), hosts)) {
    return RefusedUpgrade{
        http::status::misdirected_request,
        "the Host header names neither an address nor localhost; --host-name allows a "
        "name"};
  }
  if (!IsAllowedOrigin(View(request[http::field::origin]), hosts)) {
    return RefusedUpgrade{
        http::status::forbidden,
        "a page of this origin may not read the fleet; --host-name allows its name"};
  }
  if (!websocket::is_upgrade(request)) {
    return RefusedUpgrade{http::status::upgrade_required,
                          "this is a WebSocket for Foxglove; the page is at --port"};
  }
  if (ChooseFoxgloveProtocol(View(request[http::field::sec_websocket_protocol])).empty()) {
    return RefusedUpgrade{http::status::bad_request,
                          "no subprotocol that is spoken here; there are foxglove.websocket.v1 and "
                          "foxglove.sdk.v1"};
  }
  return std::nullopt;
}

}  // namespace

// All of it but Wanted, Figures and the posting of samples happens on the one thread.
struct FoxgloveServer::Impl {
  class Connection;

  explicit Impl(FoxgloveOptions given)
      : options(std::move(given)), acceptor(context), retry(context) {
    session = std::to_string(std::chrono::system_clock::now().time_since_epoch().count());
    advertise = std::make_shared<const std::string>(AdvertiseText(options.channels));
  }

  void Bind();
  void Accept();
  void Run();
  void UpdateWanted();
  void Deliver(const std::vector<SharedSample>& samples, std::uint64_t kept);

  FoxgloveOptions options;
  std::string session;
  std::shared_ptr<const std::string> advertise;  // the same for all clients, some 100 kB
  std::set<Connection*> connections;
  KeptSamples kept_samples;
  std::atomic<std::uint64_t> wanted{0};
  std::atomic<std::uint64_t> refused{0};
  std::atomic<int> clients{0};
  asio::io_context context{1};  // after what connections use: it destroys those that are left
  tcp::acceptor acceptor;
  asio::steady_timer retry;
  std::thread thread;
};

// From the first byte to the last. Lives as long as one of its operations is pending.
class FoxgloveServer::Impl::Connection : public std::enable_shared_from_this<Connection> {
 public:
  Connection(Impl& server, tcp::socket socket)
      : server_(server), socket_(std::move(socket)), stalled_(server.context) {
    BoundKernel(beast::get_lowest_layer(socket_).socket().native_handle());
    request_.header_limit(kLongestHandshake);
    server_.connections.insert(this);
  }
  ~Connection() {
    server_.connections.erase(this);
    if (!is_client_) return;
    --server_.clients;
    server_.UpdateWanted();
  }
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  void Start() {
    beast::get_lowest_layer(socket_).expires_after(kHandshakeTime);
    http::async_read_header(beast::get_lowest_layer(socket_), received_, request_,
                            [self = shared_from_this()](const error_code& error, std::size_t) {
                              if (!error) self->CheckHandshake();
                            });
  }
  const NewestSamples& Samples() const { return samples_; }
  void Offer(const SharedSample& sample) { samples_.Offer(sample); }
  void WriteNext();

 private:
  void CheckHandshake();
  void Refuse(const RefusedUpgrade& refusal);
  void Greet();
  void ReadNext();
  void Handle();
  void Subscribe(const FoxgloveSubscription& wanted);
  void SendStatus(FoxgloveLevel level, const std::string& message) {
    ++server_.refused;
    Send(std::make_shared<const std::string>(StatusText(level, message)));
  }
  void Send(std::shared_ptr<const std::string> text) {
    if (texts_.size() >= kMostTexts) return End();  // it asks, and does not take the answers
    texts_.push_back(std::move(text));
  }
  void End() { beast::get_lowest_layer(socket_).close(); }
  template <typename Buffers>
  void Write(bool binary, const Buffers& buffers);

  Impl& server_;
  websocket::stream<beast::tcp_stream> socket_;
  asio::steady_timer stalled_;  // runs while something is written
  beast::flat_buffer received_{kLongestMessage};
  http::request_parser<http::empty_body> request_;
  http::response<http::string_body> refusal_;
  bool is_client_ = false;
  bool writing_ = false;
  NewestSamples samples_;
  std::deque<std::shared_ptr<const std::string>> texts_;
  // What is being written.
  std::shared_ptr<const std::string> text_;
  std::optional<NewestSamples::Due> due_;
  std::array<std::uint8_t, kFoxgloveHeadBytes> head_{};
};

void FoxgloveServer::Impl::Connection::CheckHandshake() {
  if (const auto refusal = RefusalOf(request_.get(), server_.options.host_names)) {
    return Refuse(*refusal);
  }
  if (server_.clients >= kMostClients) {
    return Refuse(
        {http::status::service_unavailable, "16 clients are served already; close one of them"});
  }
  is_client_ = true;
  ++server_.clients;
  auto& transport = beast::get_lowest_layer(socket_);
  transport.expires_never();  // the WebSocket has timers of its own
  socket_.set_option(websocket::stream_base::timeout{kHandshakeTime, kIdleTime, true});
  const std::string protocol(
      ChooseFoxgloveProtocol(View(request_.get()[http::field::sec_websocket_protocol])));
  socket_.set_option(
      websocket::stream_base::decorator([protocol](websocket::response_type& response) {
        response.set(http::field::sec_websocket_protocol, protocol);
      }));
  socket_.read_message_max(kLongestMessage);
  socket_.auto_fragment(false);
  socket_.async_accept(request_.get(), [self = shared_from_this()](const error_code& error) {
    if (!error) self->Greet();
  });
}

void FoxgloveServer::Impl::Connection::Refuse(const RefusedUpgrade& refusal) {
  ++server_.refused;
  refusal_ = {refusal.status, request_.get().version()};
  refusal_.set(http::field::content_type, "text/plain; charset=utf-8");
  refusal_.keep_alive(false);
  refusal_.body() = refusal.why + "\n";
  refusal_.prepare_payload();
  http::async_write(beast::get_lowest_layer(socket_), refusal_,
                    [self = shared_from_this()](const error_code& error, std::size_t) {
                      error_code ignored;
                      auto& socket = beast::get_lowest_layer(self->socket_).socket();
                      if (!error) socket.shutdown(tcp::socket::shutdown_send, ignored);
                    });
}

void FoxgloveServer::Impl::Connection::Greet() {
  received_.consume(received_.size());
  Send(std::make_shared<const std::string>(ServerInfoText(server_.options.name, server_.session)));
  Send(server_.advertise);
  WriteNext();
  ReadNext();
}

void FoxgloveServer::Impl::Connection::ReadNext() {
  socket_.async_read(received_, [self = shared_from_this()](const error_code& error, std::size_t) {
    if (error) return self->End();
    self->Handle();
    self->received_.consume(self->received_.size());
    self->WriteNext();
    self->ReadNext();
  });
}

void FoxgloveServer::Impl::Connection::Handle() {
  if (socket_.got_binary()) {
    return SendStatus(FoxgloveLevel::kError,
                      "binary messages are not served: this server only publishes");
  }
  const auto bytes = received_.cdata();
  const FoxgloveRequest request =
      ReadFoxgloveRequest({static_cast<const char*>(bytes.data()), bytes.size()});
  if (!request.fault.empty()) return SendStatus(FoxgloveLevel::kError, request.fault);
  for (const FoxgloveSubscription& wanted : request.subscribe) Subscribe(wanted);
  for (const std::uint32_t id : request.unsubscribe) {
    const std::string fault = samples_.Unsubscribe(id);
    if (!fault.empty()) SendStatus(FoxgloveLevel::kWarning, fault);
  }
  server_.UpdateWanted();
}

void FoxgloveServer::Impl::Connection::Subscribe(const FoxgloveSubscription& wanted) {
  if (wanted.channel == 0 || wanted.channel > server_.options.channels.size()) {
    return SendStatus(FoxgloveLevel::kError,
                      "there is no channel " + std::to_string(wanted.channel));
  }
  const std::size_t topic = wanted.channel - 1;
  const std::string fault = samples_.Subscribe(wanted.id, topic);
  if (!fault.empty()) return SendStatus(FoxgloveLevel::kError, fault);
  server_.kept_samples.ForEach(topic, [this](const SharedSample& sample) { Offer(sample); });
}

template <typename Buffers>
void FoxgloveServer::Impl::Connection::Write(bool binary, const Buffers& buffers) {
  writing_ = true;
  stalled_.expires_after(kWriteTime);
  stalled_.async_wait([self = shared_from_this()](const error_code& cancelled) {
    if (!cancelled) self->End();
  });
  socket_.binary(binary);
  socket_.async_write(buffers, [self = shared_from_this()](const error_code& error, std::size_t) {
    self->writing_ = false;
    self->stalled_.cancel();
    if (error) return self->End();
    self->WriteNext();
  });
}

void FoxgloveServer::Impl::Connection::WriteNext() {
  if (writing_ || !socket_.is_open()) return;
  if (!texts_.empty()) {
    text_ = std::move(texts_.front());
    texts_.pop_front();
    return Write(false, asio::buffer(*text_));
  }
  due_ = samples_.Take();
  if (!due_) return;
  head_ = SampleHead(due_->subscription, due_->sample->reception_ns);
  Write(true,
        std::array<asio::const_buffer, 2>{asio::buffer(head_), asio::buffer(due_->sample->bytes)});
}

void FoxgloveServer::Impl::UpdateWanted() {
  std::uint64_t bits = 0;
  for (const Connection* connection : connections) {
    for (const auto& [topic, id] : connection->Samples().ByTopic())
      bits |= std::uint64_t{1} << topic;
  }
  wanted = bits;
}

void FoxgloveServer::Impl::Deliver(const std::vector<SharedSample>& samples, std::uint64_t kept) {
  for (const SharedSample& sample : samples) {
    if (((kept >> sample->topic) & 1U) != 0) kept_samples.Keep(sample);
    for (Connection* connection : connections) connection->Offer(sample);
  }
  for (Connection* connection : connections) connection->WriteNext();
}

void FoxgloveServer::Impl::Bind() {
  tcp::resolver resolver(context);
  const auto found = resolver.resolve(options.address, std::to_string(options.port),
                                      tcp::resolver::passive | tcp::resolver::numeric_service);
  const tcp::endpoint endpoint = found.begin()->endpoint();
  acceptor.open(endpoint.protocol());
  acceptor.set_option(asio::socket_base::reuse_address(true));
  acceptor.bind(endpoint);
  acceptor.listen();
}

void FoxgloveServer::Impl::Accept() {
  acceptor.async_accept([this](const error_code& error, tcp::socket socket) {
    if (error) {  // such as too many open files
      retry.expires_after(std::chrono::milliseconds(100));
      retry.async_wait([this](const error_code& cancelled) {
        if (!cancelled) Accept();
      });
      return;
    }
    if (connections.size() < kMostConnections) {
      std::make_shared<Connection>(*this, std::move(socket))->Start();
    } else {
      ++refused;
    }
    Accept();
  });
}

void FoxgloveServer::Impl::Run() {
  while (!context.stopped()) {
    try {
      context.run();
    } catch (const std::exception& error) {
      LogError("the server for Foxglove continues after: " + std::string(error.what()));
    }
  }
}

FoxgloveServer::FoxgloveServer(FoxgloveOptions options)
    : impl_(std::make_unique<Impl>(std::move(options))) {
  try {
    impl_->Bind();
  } catch (const boost::system::system_error& error) {
    throw ServerError("cannot listen on " + impl_->options.address + " port " +
                      std::to_string(impl_->options.port) + " for Foxglove: " +
                      error.code().message() + "; choose another --foxglove-port or --address");
  }
  impl_->Accept();
  const SignalsBlocked blocked;
  impl_->thread = std::thread([this] { impl_->Run(); });
}

FoxgloveServer::~FoxgloveServer() {
  impl_->context.stop();
  impl_->thread.join();
}

std::uint64_t FoxgloveServer::Wanted() const { return impl_->wanted; }

void FoxgloveServer::Publish(std::vector<link::RawSample> samples, std::uint64_t kept) {
  std::vector<SharedSample> shared;
  shared.reserve(samples.size());
  for (link::RawSample& sample : samples) {
    shared.push_back(std::make_shared<const link::RawSample>(std::move(sample)));
  }
  asio::post(impl_->context,
             [this, shared = std::move(shared), kept] { impl_->Deliver(shared, kept); });
}

void FoxgloveServer::ForgetKept() {
  asio::post(impl_->context, [this] { impl_->kept_samples.Clear(); });
}

FoxgloveFigures FoxgloveServer::Figures() const { return {impl_->clients, impl_->refused}; }

}  // namespace giveway
