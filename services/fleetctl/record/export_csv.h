// A sample as a line of CSV: the fields of its JSON, those within others with dots. Pure.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace giveway::fleetctl {

using FlatFields = std::vector<std::pair<std::string, std::string>>;  // name, value as text

// Of one of our own JSON objects. Arrays stay as they are written.
FlatFields Flattened(std::string_view json);

// The columns of a table whose rows do not all have the same fields: all of them, each after those
// that came earlier. To be collected over all rows before the first is written.
class CsvColumns {
 public:
  void Add(const FlatFields& fields);
  std::string Head() const;
  // A field that the row lacks is empty.
  std::string Row(const FlatFields& fields) const;

 private:
  std::vector<std::string> names_;
};

}  // namespace giveway::fleetctl
