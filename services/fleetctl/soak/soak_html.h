// The tables of a soak's page, a section each: its heading included, empty where there is nothing
// to show. At most so many rows as a reader wants; all of them are in report.json. Pure text.
#pragma once

#include <string>
#include <string_view>

#include "services/fleetctl/soak/soak_result.h"

namespace giveway::fleetctl {

// Anything, as text between tags and in attributes. What is no UTF-8 is replaced.
std::string HtmlText(std::string_view text);

std::string HistogramSection(const SoakResult& result);  // figures against budgets
std::string ViolationSection(const SoakResult& result);
std::string FaultSection(const SoakResult& result);       // by kind, then each
std::string SlopeSection(const SoakResult& result);       // leaks first
std::string NearMissSection(const SoakResult& result);    // the nearest first
std::string AccountingSection(const SoakResult& result);  // what differs first

}  // namespace giveway::fleetctl
