// An impairment as one word of a command line:
//
//   loss=0.1,delay=20ms,jitter=5ms,seed=7
//   loss=0.05;from=3,to=2,blackout=5s..7s;from=world
//
// Rules are separated by ';', the last that fits a packet counts. Keys are those of the scenario
// without their units; times carry one of us, ms, s. `from` is anyone, vehicles, world or an id,
// `to` an id; `blackout` may be repeated. "none" is no impairment.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "services/types/impairment.h"

namespace giveway::app {

// One thing wrong with the text: names key and value.
struct ImpairTextProblem {
  std::string message;
  std::string remedy;
};

struct ParsedImpairment {
  Impairment impairment;
  std::vector<ImpairTextProblem> problems;  // empty: the impairment is good
};

ParsedImpairment ParseImpairment(std::string_view text);

}  // namespace giveway::app
