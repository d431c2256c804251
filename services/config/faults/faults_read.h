// A parsed fault file as values. Finds every problem it can; the values are meant for use only if
// there was none. Whether the vehicles exist and what excludes what: services/faults/expand.h.
#pragma once

#include "services/config/section.h"
#include "services/faults/fault_file.h"

namespace giveway {

// `root` is of the message giveway.schema.FaultFile. Problems go to `root`.
faults::FaultFile ReadFaultFile(const Section& root);

}  // namespace giveway
