#include "services/app/violations.h"

#include "report.pb.h"
#include "services/types/check.h"

namespace giveway::app {

void SetViolations(const std::vector<BrokenInvariant>& violations, schema::Violations* message) {
  const auto* descriptor = schema::Violations::descriptor();
  for (const BrokenInvariant& broken : violations) {
    const auto* field = descriptor->FindFieldByName(broken.name);
    GIVEWAY_CHECK(field != nullptr, broken.name);
    message->GetReflection()->SetUInt32(message, field, broken.count);
  }
}

}  // namespace giveway::app
