#include <memory>
#include <string>

#include "services/fleetctl/args/duration_flag.h"
#include "services/fleetctl/args/verbs.h"
#include "services/fleetctl/process/domain_lock.h"
#include "services/fleetctl/why/why.h"

namespace giveway::fleetctl {
namespace {

constexpr const char* kWhyFooter = R"(
A and B are running processes of this machine: the id of a vehicle, "world", or pid:NUMBER, in
whatever network namespace or container. First it predicts, from each process's launch options and
network environment, whether A receives B's samples; then a reader of its own takes A's place (its
domain, profiles, interface, impairment and namespaces; other namespaces need root) and listens. A
process that is not on this machine is judged by what can be received alone.

Examples
  fleetctl why 1 2                  # does vehicle 1 hear the beacons of vehicle 2?
  fleetctl why world 2              # its commands?
  fleetctl why 2 world --domain 7   # its ranges? of several fleets the one in domain 7
  fleetctl why pid:812 pid:844 --json | jq -r '.findings[].rule'

Exit code: 0 hears on every topic; 1 does not, or prediction and probe disagree; 2 could not run, or
nothing is known.
)";

Named Parse(const std::string& name, const std::string& text) {
  if (const auto named = ParseNamed(text)) return *named;
  throw CLI::ValidationError(
      name,
      "must be the id of a vehicle (1 to 4294967295), world, or pid:NUMBER, not '" + text + "'");
}

}  // namespace

void AddWhyVerb(CLI::App* fleetctl, int* exit_code) {
  const auto options = std::make_shared<WhyOptions>();
  CLI::App* verb = fleetctl->add_subcommand("why", "Can A hear B? And if not, why");
  verb->footer(kWhyFooter);
  verb->add_option_function<std::string>(
          "A", [options](const std::string& text) { options->hearer = Parse("A", text); },
          "The receiver")
      ->required();
  verb->add_option_function<std::string>(
          "B", [options](const std::string& text) { options->speaker = Parse("B", text); },
          "The sender")
      ->required();
  verb->add_option("--domain", options->domain, "Only processes in this DDS domain")
      ->check(CLI::Range(kFirstDomain, kLastDomain));
  AddTimeFlag(verb, "--duration,--seconds", &options->seconds,
              "The probe listens at most so long [3s where silence is predicted, else 10s]");
  verb->add_flag("!--no-probe", options->probe, "Only predict");
  verb->add_flag("--json", options->json, "Print one JSON object on stdout and nothing else");
  verb->callback([options, exit_code] {
    if (options->hearer == options->speaker) {
      throw CLI::ValidationError(
          "B", "is A, and a process does not receive its own samples; name two processes");
    }
    *exit_code = RunWhy(*options);
  });
}

}  // namespace giveway::fleetctl
