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

// Lines with the columns of the first; a field that a later line has and the first had not is left
// out, one that it lacks is empty.
class CsvLines {
 public:
  // The head before the first line, and the line; each with its line feed.
  std::string Add(const FlatFields& fields);

 private:
  std::vector<std::string> columns_;
};

}  // namespace giveway::fleetctl
