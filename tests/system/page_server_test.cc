// The page's server with clients that are slow, over real sockets of the loopback.
#include "services/observer/server/page_server.h"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <chrono>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

namespace giveway {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr std::size_t kFrameBytes = 20'000;

sockaddr_in Loopback(std::uint16_t port) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  address.sin_port = htons(port);
  return address;
}

std::uint16_t FreePort() {
  const int socket = ::socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address = Loopback(0);
  socklen_t size = sizeof(address);
  ::bind(socket, reinterpret_cast<const sockaddr*>(&address), size);
  ::getsockname(socket, reinterpret_cast<sockaddr*>(&address), &size);
  ::close(socket);
  return ntohs(address.sin_port);
}

int Connected(std::uint16_t port, int receive_buffer = 64 << 10) {
  const int socket = ::socket(AF_INET, SOCK_STREAM, 0);
  setsockopt(socket, SOL_SOCKET, SO_RCVBUF, &receive_buffer, sizeof(receive_buffer));
  const timeval patience{.tv_sec = 5, .tv_usec = 0};
  setsockopt(socket, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof(patience));
  const sockaddr_in address = Loopback(port);
  EXPECT_EQ(::connect(socket, reinterpret_cast<const sockaddr*>(&address), sizeof(address)), 0);
  return socket;
}

void Send(int socket, std::string_view text) {
  EXPECT_EQ(::send(socket, text.data(), text.size(), MSG_NOSIGNAL),
            static_cast<ssize_t>(text.size()));
}

// Follows the stream with the smallest buffer that the kernel allows.
class SlowClient {
 public:
  explicit SlowClient(std::uint16_t port) : socket_(Connected(port, 4096)) {
    Send(socket_, "GET /api/v1/stream HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n");
  }
  ~SlowClient() { ::close(socket_); }
  SlowClient(const SlowClient&) = delete;
  SlowClient& operator=(const SlowClient&) = delete;

  // What arrives until a frame of at least this number; everything if none comes.
  std::string ReadUntilFrame(int number) const {
    std::string text;
    std::array<char, 4096> some;
    while (Newest(text) < number) {
      const ssize_t got = ::recv(socket_, some.data(), some.size(), 0);
      if (got <= 0) break;
      text.append(some.data(), static_cast<std::size_t>(got));
    }
    return text;
  }
  static int Newest(const std::string& text) {
    constexpr std::string_view kMark = "frame-";
    const std::size_t at = text.rfind(kMark);
    return at == std::string::npos ? 0 : std::atoi(text.c_str() + at + kMark.size());
  }

 private:
  const int socket_;
};

class PageServerTest : public ::testing::Test {
 protected:
  PageServerTest() : port_(FreePort()), server_("127.0.0.1", port_, Sources(&board_)) {}
  ~PageServerTest() override { board_.Close(); }

  static PageSources Sources(const FrameBoard* board) {
    PageSources sources;
    sources.get = [](const std::string& path, const auto&) -> std::optional<PageAnswer> {
      if (path != "/livez") return std::nullopt;
      return PageAnswer{.body = "live"};
    };
    sources.scene = "{}";
    sources.frames = board;
    return sources;
  }
  // A hundred a second, for that long; returns the number of the last.
  int Publish(milliseconds time) {
    const auto end = std::chrono::steady_clock::now() + time;
    while (std::chrono::steady_clock::now() < end) {
      board_.Publish("frame-" + std::to_string(++published_) + " " + std::string(kFrameBytes, 'x'));
      std::this_thread::sleep_for(milliseconds(10));
    }
    return published_;
  }
  bool Within(seconds limit, int streams) {
    const auto end = std::chrono::steady_clock::now() + limit;
    while (server_.Figures().streams != streams) {
      if (std::chrono::steady_clock::now() > end) return false;
      Publish(milliseconds(20));
    }
    return true;
  }

  const std::uint16_t port_;
  FrameBoard board_;
  int published_ = 0;
  PageServer server_;
};

TEST_F(PageServerTest, AClientThatWasSlowIsSoonAtTheNewestFrame) {
  const SlowClient client(port_);
  ASSERT_TRUE(Within(seconds(5), 1));
  client.ReadUntilFrame(1);
  const int newest = Publish(seconds(3));  // of which it reads nothing
  ASSERT_GT(newest, 100);
  std::atomic<bool> over{false};
  std::thread publisher([&] {
    while (!over) Publish(milliseconds(20));
  });
  const std::string text = client.ReadUntilFrame(newest);
  over = true;
  publisher.join();
  EXPECT_GE(SlowClient::Newest(text), newest);
  // Only what waited in the kernel on both sides, not the megabytes of the whole stream.
  EXPECT_LT(text.size(), 15 * kFrameBytes);
}

TEST_F(PageServerTest, AClientThatReadsNothingIsLeft) {
  const SlowClient client(port_);
  ASSERT_TRUE(Within(seconds(5), 1));
  EXPECT_TRUE(Within(seconds(15), 0));
}

// Of sockets, closed at the end.
class Silent {
 public:
  Silent(std::uint16_t port, int count) {
    for (int n = 0; n < count; ++n) sockets_.push_back(Connected(port));
  }
  ~Silent() {
    for (const int socket : sockets_) ::close(socket);
  }
  Silent(const Silent&) = delete;
  Silent& operator=(const Silent&) = delete;

 private:
  std::vector<int> sockets_;
};

// What is answered to these parts of a request, sent a tenth of a second apart.
std::string AnswerTo(std::uint16_t port, const std::vector<std::string>& parts) {
  const int socket = Connected(port);
  for (const std::string& part : parts) {
    if (&part != &parts.front()) std::this_thread::sleep_for(milliseconds(100));
    Send(socket, part);
  }
  std::string answer;
  std::array<char, 4096> some;
  for (ssize_t got = 1; got > 0;) {
    got = ::recv(socket, some.data(), some.size(), 0);
    if (got > 0) answer.append(some.data(), static_cast<std::size_t>(got));
  }
  ::close(socket);
  return answer;
}

// Each held a thread for two seconds: ten connections a second, and no other was answered.
TEST_F(PageServerTest, ConnectionsThatSayNothingKeepNobodyFromAnAnswer) {
  for (const int count : {40, 300}) {
    const Silent silent(port_, count);
    const auto asked = std::chrono::steady_clock::now();
    const std::string answer = AnswerTo(port_, {"GET /livez HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n"});
    EXPECT_TRUE(answer.starts_with("HTTP/1.1 200")) << count << ": " << answer;
    EXPECT_LT(std::chrono::steady_clock::now() - asked, seconds(2)) << count;
  }
}

TEST_F(PageServerTest, ARequestThatComesInPartsIsAnswered) {
  const std::string answer =
      AnswerTo(port_, {"GET /livez HT", "TP/1.1\r\nHost: 127.0.0.1\r\n", "\r\n"});
  EXPECT_TRUE(answer.starts_with("HTTP/1.1 200")) << answer;
}

TEST_F(PageServerTest, ARequestThatNeverEndsIsLeft) {
  const auto asked = std::chrono::steady_clock::now();
  AnswerTo(port_, {"GET /livez HTTP/1.1\r\n"});
  EXPECT_LT(std::chrono::steady_clock::now() - asked, seconds(4));
}

TEST_F(PageServerTest, AStreamStartsWithAFrameThatIsNew) {
  const int before = Publish(milliseconds(50));
  const SlowClient client(port_);
  ASSERT_TRUE([this] {  // without frames of its own
    for (int n = 0; n < 500 && server_.Figures().streams == 0; ++n) {
      std::this_thread::sleep_for(milliseconds(10));
    }
    return server_.Figures().streams == 1;
  }());
  Publish(milliseconds(50));
  const std::string text = client.ReadUntilFrame(before + 1);
  EXPECT_EQ(text.find("frame-" + std::to_string(before) + " "), std::string::npos);
  EXPECT_GT(SlowClient::Newest(text), before);
}

}  // namespace
}  // namespace giveway
