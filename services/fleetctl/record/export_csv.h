// A sample as a line of CSV: the fields of its JSON, those within others with dots. Pure.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "services/runtime/json.h"

namespace giveway::fleetctl {

using FlatFields = std::vector<std::pair<std::string, std::string>>;  // name, value as text

// What does not exist is left out, as JsonText leaves it out; arrays are as it writes them.
FlatFields Flattened(const Json& sample);

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
