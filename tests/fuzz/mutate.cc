#include "tests/fuzz/mutate.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cctype>
#include <limits>
#include <string_view>

#include "services/types/check.h"

namespace giveway::fuzz {
namespace {

constexpr std::uint64_t kMostChanges = 8;
constexpr std::size_t kLongestPiece = 256;

using Limits = std::numeric_limits<double>;
constexpr std::array kOddDoubles = {0.0,
                                    -0.0,
                                    1.0,
                                    -1.0,
                                    1e-3,
                                    1e6,
                                    -1e6,
                                    1e18,
                                    1e154,
                                    Limits::max(),
                                    -Limits::max(),
                                    1e-9,
                                    31.0,
                                    100.0,
                                    -100.0,
                                    1e-6,
                                    2e-2,
                                    1e-154,
                                    1e-300,
                                    1e9,
                                    Limits::min(),
                                    Limits::infinity(),
                                    -Limits::infinity(),
                                    Limits::quiet_NaN(),
                                    Limits::denorm_min()};
constexpr std::array<std::uint32_t, 10> kOddWords = {0,   1,   2,          3,          16,
                                                     255, 256, 0x7fffffff, 0x80000000, 0xffffffff};
constexpr std::array<std::string_view, 20> kOddNumbers = {
    "0",      "-1", "1e-9",  "1e400", "nan", "inf", "-inf", "4294967295", "4294967296", "0x10",
    "1e-300", "20", "10000", "-0",    "1",   "2",   "3.5",  "0.05",       "2.5",        "1000"};
constexpr std::array<std::string_view, 16> kOddPieces = {"{",
                                                         "}",
                                                         "<",
                                                         "[",
                                                         "]",
                                                         ":",
                                                         "\"",
                                                         "\\",
                                                         "\n",
                                                         "\t",
                                                         "#",
                                                         "\r",
                                                         "\xc3\xa9",
                                                         "\xed\xa0\x80",
                                                         "\xf4\x90\x80\x80",
                                                         "[a.b/c] {"};

// Draws of one input.
class Dice {
 public:
  Dice(std::uint64_t seed, std::uint64_t number) : random_(seed, number) {}
  // In [0, below); 0 if `below` is 0.
  std::size_t Below(std::size_t below) { return below == 0 ? 0 : random_.Next() % below; }
  template <typename Range>
  auto OneOf(const Range& range) {
    return range[Below(range.size())];
  }

 private:
  Random random_;
};

void Overwrite(Input* input, std::size_t at, std::string_view bytes) {
  for (std::size_t i = 0; i < bytes.size() && at + i < input->size(); ++i) {
    (*input)[at + i] = bytes[i];
  }
}

template <typename Number>
void OverwriteNumber(Input* input, std::size_t at, Number number) {
  const auto bytes = std::bit_cast<std::array<char, sizeof(Number)>>(number);
  Overwrite(input, at, {bytes.data(), bytes.size()});
}

// Any stretch of digits in a text becomes another number.
void ReplaceNumber(Input* input, Dice* dice) {
  const auto digit = [](char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; };
  const auto from = input->begin() + static_cast<std::ptrdiff_t>(dice->Below(input->size()));
  const auto begin = std::find_if(from, input->end(), digit);
  const auto end =
      std::find_if_not(begin, input->end(), [&](char c) { return digit(c) || c == '.'; });
  if (begin != end) input->replace(begin, end, dice->OneOf(kOddNumbers));
}

// A piece of `source`: whole lines half of the time, where it has any.
std::string_view Piece(const Input& source, Dice* dice) {
  std::size_t begin = dice->Below(source.size());
  std::size_t bytes = 1 + dice->Below(kLongestPiece);
  if (dice->Below(2) == 0) {
    const std::size_t line = source.rfind('\n', begin);
    begin = line == Input::npos ? begin : line;
    const std::size_t end = source.find('\n', begin + 1 + dice->Below(kLongestPiece));
    bytes = end == Input::npos ? bytes : end - begin;
  }
  return std::string_view(source).substr(begin, bytes);
}

void Change(Input* input, const Input& other, Dice* dice) {
  const std::size_t at = dice->Below(input->size() + 1);
  switch (dice->Below(10)) {
    case 0:
      if (at < input->size()) (*input)[at] ^= static_cast<char>(1U << dice->Below(8));
      return;
    case 1:
      if (at < input->size()) (*input)[at] = static_cast<char>(dice->Below(256));
      return;
    case 2:
      return OverwriteNumber(input, at, dice->OneOf(kOddDoubles));
    case 3:
      return OverwriteNumber(input, at, dice->OneOf(kOddWords));
    case 4:
      input->insert(at, dice->OneOf(kOddPieces));
      return;
    case 5:
      input->erase(at, 1 + dice->Below(kLongestPiece));
      return;
    case 6:
      input->insert(at, std::string(Piece(dice->Below(2) == 0 ? *input : other, dice)));
      return;
    case 7:
      return Overwrite(input, at, std::string(Piece(other, dice)));
    case 8:
      input->resize(at);  // cut off
      return;
    default:
      return ReplaceNumber(input, dice);
  }
}

}  // namespace

Mutator::Mutator(std::uint64_t seed, std::vector<Input> samples)
    : seed_(seed), samples_(std::move(samples)) {
  GIVEWAY_CHECK(!samples_.empty());
}

Input Mutator::Make(std::uint64_t number) const {
  if (number < samples_.size()) return samples_[number];
  Dice dice(seed_, number);
  Input input = samples_[dice.Below(samples_.size())];
  // Few changes pass more of the checks, many reach rarer branches.
  for (std::size_t left = 1 + dice.Below(1 + dice.Below(kMostChanges)); left > 0; --left) {
    Change(&input, samples_[dice.Below(samples_.size())], &dice);
  }
  if (input.size() > kMaxInputBytes) input.resize(kMaxInputBytes);
  return input;
}

}  // namespace giveway::fuzz
