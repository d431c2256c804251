#include "services/qos/xml_value.h"

#include <tinyxml2.h>

#include <algorithm>
#include <charconv>

#include "services/qos/policy.h"

namespace giveway::qos {
namespace {

constexpr std::int64_t kSecond = 1'000'000'000;
constexpr std::int64_t kInfiniteSeconds = 0x7fff'ffff;
constexpr std::int64_t kInfiniteNanoseconds = 0xffff'ffff;
constexpr std::string_view kBlanks = " \t\r\n\f\v";

std::string_view Trimmed(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(kBlanks);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(kBlanks) - begin + 1);
}

// A fraction of nothing but zeros says no more than the digits before it.
std::string_view WithoutZeroFraction(std::string_view text) {
  const std::size_t point = text.find('.');
  if (point == std::string_view::npos || point == 0) return text;
  const std::string_view fraction = text.substr(point + 1);
  return fraction.find_first_not_of('0') == std::string_view::npos ? text.substr(0, point) : text;
}

// The number that a person reads in the text; nothing if there is more than a number.
std::optional<std::int64_t> Meant(std::string_view text) {
  text = Trimmed(text);
  const bool negative = text.starts_with('-');
  if (negative || text.starts_with('+')) text.remove_prefix(1);
  const bool hex = text.starts_with("0x") || text.starts_with("0X");
  if (hex) text.remove_prefix(2);
  if (!hex) text = WithoutZeroFraction(text);
  std::uint32_t number = 0;
  const auto [end, error] = std::from_chars(text.begin(), text.end(), number, hex ? 16 : 10);
  if (text.empty() || error != std::errc() || end != text.end()) return std::nullopt;
  return negative ? -std::int64_t{number} : std::int64_t{number};
}

}  // namespace

std::optional<Number> ReadNumber(const std::string& text, NumberKind kind) {
  Number number;
  if (kind == NumberKind::kUnsigned) {
    unsigned read = 0;
    if (!tinyxml2::XMLUtil::ToUnsigned(text.c_str(), &read)) return std::nullopt;
    number.value = read;
  } else {
    int read = 0;
    if (!tinyxml2::XMLUtil::ToInt(text.c_str(), &read)) return std::nullopt;
    number.value = read;
  }
  const auto meant = Meant(text);
  const bool largest = kind == NumberKind::kUnsigned && meant == -1;
  number.exact = largest || meant == number.value;
  return number;
}

std::optional<bool> ReadFlag(const std::string& text) {
  bool flag = false;
  if (!tinyxml2::XMLUtil::ToBool(text.c_str(), &flag)) return std::nullopt;
  return flag;
}

bool IsInfinite(std::string_view text) {
  return WordIndex("DURATION_INFINITY DURATION_INFINITE_SEC DURATION_INFINITE_NSEC",
                   Trimmed(text)) >= 0;
}

std::optional<std::int64_t> ReadDuration(const XmlElement& element) {
  if (element.children.empty())
    return IsInfinite(element.text) ? std::optional(kInfinite) : std::nullopt;
  std::int64_t seconds = 0;
  std::int64_t nanoseconds = 0;
  for (const XmlElement& child : element.children) {
    if (IsInfinite(child.text)) return kInfinite;
    const bool whole = child.name == "sec";
    if (!whole && child.name != "nanosec") return std::nullopt;
    const auto number = ReadNumber(child.text, whole ? NumberKind::kSigned : NumberKind::kUnsigned);
    if (!number) return std::nullopt;
    (whole ? seconds : nanoseconds) = number->value;
  }
  // To the library 2147483647 s alone is a time, and less than infinite.
  if (seconds == kInfiniteSeconds && nanoseconds == kInfiniteNanoseconds) return kInfinite;
  if (seconds < 0 || nanoseconds >= kSecond) return std::nullopt;
  return seconds * kSecond + nanoseconds;
}

}  // namespace giveway::qos
