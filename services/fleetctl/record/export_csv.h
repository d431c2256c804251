// A sample as a line of CSV: the fields of its JSON, nested ones with dots. Pure.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace giveway::fleetctl {

using FlatFields = std::vector<std::pair<std::string, std::string>>;  // name, value as text

// Of one of our own JSON objects. Arrays stay as they are written.
FlatFields Flattened(std::string_view json);

// The columns of a table whose rows do not all have the same fields: all of them, in order of first
// appearance. Collect over all rows before writing the first.
class CsvColumns {
 public:
  void Add(const FlatFields& fields);
  std::string Head() const;
  // A field that is missing in the row is empty.
  std::string Row(const FlatFields& fields) const;

 private:
  std::vector<std::string> names_;
};

}  // namespace giveway::fleetctl
