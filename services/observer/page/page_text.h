// The page that shows a fleet: live from a stream, or with the data of a run inside.
#pragma once

#include <string>
#include <string_view>

namespace giveway {

// As a browser gets it: follows /api/v1/stream of where it came from.
std::string PageText();

// The same page with a finished run in it, {"scene":{…},"frames":[{…},…]}: needs no server.
std::string PageWithRun(std::string_view run_json);

}  // namespace giveway
