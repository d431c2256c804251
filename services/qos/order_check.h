// What a profile set may hold that comes in an order over DDS, from a sender that nothing vouches
// for: an allow-list of elements, each with the largest number it may hold. All else is refused
// unless the process runs with the very same already: elements that make the library write files,
// send elsewhere, load parts, or reserve memory.
#pragma once

#include <string>

#include "services/qos/finding.h"
#include "services/qos/xml_tree.h"

namespace giveway::qos {

// `running` is the set that the process has now.
Findings CheckOrder(const XmlElement& wanted, const XmlElement& running, const std::string& file);

}  // namespace giveway::qos
