// A sample as a line of CSV: the fields of its JSON, nested ones with dots. Pure.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "services/runtime/json.h"

namespace giveway::fleetctl {

using FlatFields = std::vector<std::pair<std::string, std::string>>;  // name, value as text

// Null values are left out, as JsonText leaves them out; arrays are as it writes them.
FlatFields Flattened(const Json& sample);

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
