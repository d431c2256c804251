// The page, its stream of frames and what else there is to read, over HTTP on one port. Reads only
// what its sources give it, on threads of its own; a client is given so much time and so many
// bytes, whatever it does.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "services/observer/server/frame_board.h"

namespace giveway {

// The port cannot be listened on; what() says why, and what to do.
class ServerError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct PageAnswer {
  std::string body;
  std::string type = "application/json";
  int status = 200;
};

struct ServerFigures {
  int streams = 0;            // clients that follow the stream now
  std::uint64_t refused = 0;  // streams turned away, foreign hosts, other methods
};

struct PageSources {
  std::string page;  // of /
  // Any other path; nothing: 404. Called on the server's threads, as soon as it listens.
  std::function<std::optional<PageAnswer>(const std::string& path, const ServerFigures& server)>
      get;
  std::string scene;  // first on every stream; without line feeds
  const FrameBoard* frames =
      nullptr;  // later ones go to streams, of /api/v1/stream; null: there is none
  std::vector<std::string> host_names;  // besides localhost and addresses
};

class PageServer {
 public:
  static constexpr int kMostStreams = 16;

  // Listens from here on. Throws ServerError.
  PageServer(const std::string& address, std::uint16_t port, PageSources sources);
  // Closes the port and leaves clients behind. The board must be closed before.
  ~PageServer();
  PageServer(const PageServer&) = delete;
  PageServer& operator=(const PageServer&) = delete;

  ServerFigures Figures() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace giveway
