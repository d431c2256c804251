// What makes a service of the benchmark filter_cost.sh one without the packet filter. Linked before
// the service's libraries, in programs that are never installed; nothing that ships can do without.
#include <memory>

#include "services/link/fastdds/filtered_transport.h"

// The linker sends the one call to this (--wrap in CMakeLists.txt).
std::shared_ptr<giveway::link::transport::TransportDescriptorInterface> WithoutFilter(
    std::shared_ptr<giveway::link::transport::TransportDescriptorInterface> below,
    const giveway::link::FilteredTransportOptions& options) asm("__wrap_" GIVEWAY_FILTER_SYMBOL);

std::shared_ptr<giveway::link::transport::TransportDescriptorInterface> WithoutFilter(
    std::shared_ptr<giveway::link::transport::TransportDescriptorInterface> below,
    const giveway::link::FilteredTransportOptions& /*options*/) {
  return below;
}
