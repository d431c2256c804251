// Holds a profile file against the tables of schema.h: unknown elements, values of the wrong kind,
// elements given twice or empty, and what the library accepts without effect.
#pragma once

#include <string>

#include "services/qos/finding.h"
#include "services/qos/xml_tree.h"

namespace giveway::qos {

void CheckSchema(const XmlElement& root, const std::string& file, Findings* findings);

}  // namespace giveway::qos
