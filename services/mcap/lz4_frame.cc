#include "services/mcap/lz4_frame.h"

#include <lz4frame.h>

#include <memory>

namespace giveway::mcap {
namespace {

struct FreeContext {
  void operator()(LZ4F_dctx* context) const { LZ4F_freeDecompressionContext(context); }
};

}  // namespace

std::optional<std::string> ToLz4Frame(std::string_view bytes) {
  std::string frame(LZ4F_compressFrameBound(bytes.size(), nullptr), '\0');
  const std::size_t size =
      LZ4F_compressFrame(frame.data(), frame.size(), bytes.data(), bytes.size(), nullptr);
  if (LZ4F_isError(size) != 0) return std::nullopt;
  frame.resize(size);
  return frame;
}

std::optional<std::string> FromLz4Frame(std::string_view frame, std::uint64_t size) {
  LZ4F_dctx* made = nullptr;
  if (LZ4F_isError(LZ4F_createDecompressionContext(&made, LZ4F_VERSION)) != 0) return std::nullopt;
  const std::unique_ptr<LZ4F_dctx, FreeContext> context(made);
  std::string bytes(size, '\0');
  std::size_t filled = 0;
  while (!frame.empty()) {
    std::size_t written = bytes.size() - filled;
    std::size_t taken = frame.size();
    const std::size_t more = LZ4F_decompress(context.get(), bytes.data() + filled, &written,
                                             frame.data(), &taken, nullptr);
    if (LZ4F_isError(more) != 0) return std::nullopt;
    filled += written;
    frame.remove_prefix(taken);
    if (more == 0) break;
    if (taken == 0 && written == 0) return std::nullopt;
  }
  if (filled != size || !frame.empty()) return std::nullopt;
  return bytes;
}

}  // namespace giveway::mcap
