// One message of a protobuf text file, read field by field. Each reader checks presence, finiteness
// and range, and adds a Problem with line, path and the value as written instead of throwing, so
// that one reading finds everything. Field names are those of the schema; a wrong one is our bug.
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "services/config/problem.h"

namespace google::protobuf {
class Message;
}

namespace giveway {

// The numbers a field may hold: [low, high], or (low, high] where `above_low`.
struct Allowed {
  double low = 0;
  double high = 0;
  std::string_view unit = "";
  bool above_low = false;

  bool Contains(double value) const {
    return (above_low ? value > low : value >= low) && value <= high;
  }
};

inline constexpr Allowed kWholeNumber{0, 4294967295.0};

// "between 0 and 5 m", "above 0 and at most 5 m".
std::string Describe(const Allowed& allowed);

// What a number that is missing or refused is read as: every comparison with it is false, so one
// bad number gives one problem and not a row of them.
inline constexpr double kUnusable = std::numeric_limits<double>::quiet_NaN();

class Section {
 public:
  bool Has(std::string_view field) const;
  // Where it starts, from 1.
  int Line() const;
  // Of a repeated field.
  int Count(std::string_view field) const;

  // Required numbers: kUnusable, or 0 for whole ones, where missing or refused.
  double Number(std::string_view field, const Allowed& allowed) const;
  std::uint32_t Uint(std::string_view field, const Allowed& allowed) const;
  // The fallback stands in for an absent field only; refused is kUnusable or 0 here too.
  double NumberOr(double fallback, std::string_view field, const Allowed& allowed) const;
  std::uint32_t UintOr(std::uint32_t fallback, std::string_view field,
                       const Allowed& allowed) const;
  bool FlagOr(bool fallback, std::string_view field) const;
  // Repeated numbers; none where there are more than `most`, which is a problem.
  std::vector<double> Numbers(std::string_view field, const Allowed& allowed, int most) const;
  // Empty if absent.
  std::string Text(std::string_view field) const;
  // Of a repeated field.
  std::vector<std::string> Texts(std::string_view field) const;
  // The number of an enum's value; nothing if absent or none the schema knows.
  std::optional<int> Enum(std::string_view field) const;

  std::optional<Section> Child(std::string_view field) const;
  // As Child, but its absence is a problem.
  std::optional<Section> RequiredChild(std::string_view field) const;
  std::vector<Section> Children(std::string_view field) const;

  // Adds a problem about a field of this section, or about the section itself if `field` is empty.
  // An absent field is blamed on the line where the section starts.
  void AddError(std::string_view field, std::string message, std::string remedy,
                int index = -1) const;
  void AddMissingError(std::string_view field, std::string remedy) const;
  // Of the whole file so far, in order of lines.
  std::vector<Problem> Problems() const;

 private:
  struct File;  // what all sections of a file share
  struct Node;  // where this one is

  friend Section ParseText(const std::string&, const std::string&,
                           const google::protobuf::Message&);
  explicit Section(std::shared_ptr<const Node> node) : node_(std::move(node)) {}
  double CheckedNumber(std::string_view field, const Allowed& allowed, int index) const;
  Section Child(std::string_view field, int index) const;

  std::shared_ptr<const Node> node_;
};

// Parses protobuf text into the root section of a message like `prototype`. Unknown fields are
// problems of the root. Throws InputError at the first error of syntax, with the unknown fields
// before it.
Section ParseText(const std::string& file, const std::string& text,
                  const google::protobuf::Message& prototype);

}  // namespace giveway
