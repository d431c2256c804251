#include "services/fleetctl/soak/soak_result.h"

#include <fmt/format.h>

#include <algorithm>

namespace giveway::fleetctl {

std::string NameOf(const SoakFault& fault) { return fmt::format("{}#{}", fault.rule, fault.nth); }

bool WithinBudgets(const SoakHistogram& measured) {
  return measured.histogram.Count() == 0 ||
         std::ranges::all_of(measured.budgets, [&measured](const HistogramBudget& budget) {
           return measured.histogram.Quantile(budget.quantile) <= budget.most;
         });
}

const char* ToString(HistogramUnit unit) {
  switch (unit) {
    case HistogramUnit::kNanoseconds:
      return "ns";
    case HistogramUnit::kMicrometres:
      return "um";
    case HistogramUnit::kPartsPerMillion:
      return "ppm";
  }
  return "ns";
}

std::optional<HistogramUnit> HistogramUnitOf(const std::string& word) {
  for (const HistogramUnit unit : {HistogramUnit::kNanoseconds, HistogramUnit::kMicrometres,
                                   HistogramUnit::kPartsPerMillion}) {
    if (word == ToString(unit)) return unit;
  }
  return std::nullopt;
}

const char* ToString(ResourceKind kind) {
  switch (kind) {
    case ResourceKind::kPrivateBytes:
      return "private_bytes";
    case ResourceKind::kHeapBytes:
      return "heap_bytes";
    case ResourceKind::kResidentBytes:
      return "resident_bytes";
    case ResourceKind::kDescriptors:
      return "descriptors";
    case ResourceKind::kThreads:
      return "threads";
    case ResourceKind::kProcessors:
      return "processors";
    case ResourceKind::kSharedMemoryBytes:
      return "shared_memory_bytes";
  }
  return "private_bytes";
}

std::optional<ResourceKind> ResourceKindOf(const std::string& word) {
  for (std::size_t i = 0; i < kResourceKinds; ++i) {
    const auto kind = static_cast<ResourceKind>(i);
    if (word == ToString(kind)) return kind;
  }
  return std::nullopt;
}

int ExitCode(SoakVerdict verdict) {
  if (verdict == SoakVerdict::kPassed) return 0;
  return verdict == SoakVerdict::kNotRun ? 2 : 1;
}

const char* ToString(SoakVerdict verdict) {
  switch (verdict) {
    case SoakVerdict::kPassed:
      return "passed";
    case SoakVerdict::kFailed:
      return "failed";
    case SoakVerdict::kNotRun:
      return "not_run";
    case SoakVerdict::kInterrupted:
      return "interrupted";
  }
  return "not_run";
}

}  // namespace giveway::fleetctl
