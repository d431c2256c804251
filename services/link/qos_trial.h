// Whether the library makes the participant and the endpoints of a profile set, here and now.
#pragma once

#include "services/link/fastdds/link_options.h"

namespace giveway::link {

// Makes them all on the interface and in the domain of `options`, on topics of their own that
// matches no other, and deletes them. It may hang or end the process: for a process that is spared.
// Throws LinkError.
void TryQos(const LinkOptions& options);

}  // namespace giveway::link
