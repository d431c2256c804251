// The tables of a soak's page, one section each: with its heading, empty if there is nothing to
// show. A limited number of rows; report.json has all of them. Pure text.
#pragma once

#include <string>
#include <string_view>

#include "services/fleetctl/soak/soak_result.h"

namespace giveway::fleetctl {

// Escapes any text, between tags and in attributes. Invalid UTF-8 is replaced.
std::string HtmlText(std::string_view text);

std::string HistogramSection(const SoakResult& result);  // figures against budgets
std::string ViolationSection(const SoakResult& result);
std::string FaultSection(const SoakResult& result);       // by kind, then one by one
std::string SlopeSection(const SoakResult& result);       // leaks first
std::string NearMissSection(const SoakResult& result);    // the nearest first
std::string AccountingSection(const SoakResult& result);  // mismatches first

}  // namespace giveway::fleetctl
