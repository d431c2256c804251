// The defects of `vehicle_with_defects`, a giveway-vehicle for tests of what a soak finds:
// GIVEWAY_DEFECT names a defect of the brain (tests/support/mutant_names.h), or leak, descriptor
// or slow_loop. Empty or unset: no defect, and the vehicle behaves like the product's. Linked
// before its libraries.
#include <fcntl.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <string_view>
#include <thread>

#include "services/runtime/process.h"
#include "services/vehicle/vehicle.h"
#include "tests/support/mutant_names.h"

namespace giveway {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

std::string_view Planted() {
  const char* const name = std::getenv("GIVEWAY_DEFECT");
  return name == nullptr ? "" : name;
}

// 1 kB a second, in touched pages.
[[noreturn]] void Leak() {
  constexpr std::size_t kBytes = 4096;
  while (true) {
    std::memset(std::malloc(kBytes), 1, kBytes);
    std::this_thread::sleep_for(seconds(4));
  }
}

// One every five seconds.
[[noreturn]] void LoseDescriptors() {
  while (true) {
    static_cast<void>(::open("/dev/null", O_RDONLY | O_CLOEXEC));
    std::this_thread::sleep_for(seconds(5));
  }
}

// Before main: the brain is asked for its defects when the first vehicle is made.
const bool kDone = [] {
  const std::string_view name = Planted();
  if (name == "leak") {
    std::thread(Leak).detach();
  } else if (name == "descriptor") {
    std::thread(LoseDescriptors).detach();
  } else if (!name.empty() && name != "slow_loop" && !ActivateNamedMutant(name)) {
    std::fprintf(stderr, "GIVEWAY_DEFECT: no defect is called '%s'\n", std::string(name).c_str());
    std::_Exit(2);
  }
  return true;
}();

}  // namespace
}  // namespace giveway

// The linker sends the control loop's calls of Vehicle::Step to the one and the one's to the real
// (--wrap in CMakeLists.txt); by the ABI of x86-64 and of AArch64 a method is called as these are.
giveway::Outputs RealStep(giveway::Vehicle* vehicle, const giveway::Inputs& inputs) asm(
    "__real__ZN7giveway7Vehicle4StepERKNS_6InputsE");
giveway::Outputs WrappedStep(giveway::Vehicle* vehicle, const giveway::Inputs& inputs) asm(
    "__wrap__ZN7giveway7Vehicle4StepERKNS_6InputsE");

giveway::Outputs WrappedStep(giveway::Vehicle* vehicle, const giveway::Inputs& inputs) {
  static const bool slow = giveway::Planted() == "slow_loop";
  // Busy all that time: processor time is what is judged.
  const giveway::Nanoseconds until = giveway::ThreadTimeNow() + giveway::milliseconds(15);
  while (slow && giveway::ThreadTimeNow() < until) continue;
  return RealStep(vehicle, inputs);
}
