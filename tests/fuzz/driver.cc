// Runs a fuzz target without any fuzzing engine: seeded inputs for a time, or given files once. A
// child process does the work, so that whatever ends it - a check, a sanitizer, a signal, a hang -
// leaves the parent with the input that did it.
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <thread>

#include "services/types/check.h"
#include "tests/fuzz/mutate.h"

namespace giveway::fuzz {
namespace {

using Clock = std::chrono::steady_clock;

constexpr auto kPoll = std::chrono::milliseconds(50);
constexpr auto kHangs = std::chrono::seconds(30);  // one input, under sanitizers, on a busy machine

struct Options {
  std::string target;
  std::uint64_t seed = 1;
  std::uint64_t first = 0;
  std::uint64_t inputs = 0;  // 0: as many as the time allows
  double seconds = 3;
  std::string folder = ".";
  std::vector<std::string> files;
};

// What the child leaves for the parent.
struct Trace {
  std::atomic<std::uint64_t> done{0};  // inputs survived
  std::atomic<std::size_t> bytes{0};   // of the current input
  char input[kMaxInputBytes];
};
static_assert(std::atomic<std::uint64_t>::is_always_lock_free, "shared between processes");

Trace* SharedTrace() {
  void* memory =
      mmap(nullptr, sizeof(Trace), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  GIVEWAY_CHECK(memory != MAP_FAILED, std::strerror(errno));
  return new (memory) Trace;
}

void Try(const Input& input, Trace* trace) {
  const std::size_t kept = std::min(input.size(), kMaxInputBytes);
  std::copy_n(input.begin(), kept, trace->input);
  trace->bytes = kept;
  // A copy of the exact size: reading past its end is seen.
  const std::vector<std::uint8_t> bytes(input.begin(), input.end());
  LLVMFuzzerTestOneInput(bytes.data(), bytes.size());
  ++trace->done;
}

// In the child.
void TryAll(const Options& options, Trace* trace) {
  for (const std::string& file : options.files) {
    std::ifstream stream(file, std::ios::binary);
    Try({std::istreambuf_iterator<char>(stream), {}}, trace);
  }
  if (!options.files.empty()) return;
  const Mutator mutator(options.seed, Samples());
  const auto end = Clock::now() + std::chrono::duration<double>(options.seconds);
  for (std::uint64_t i = 0; options.inputs > 0 ? i < options.inputs : Clock::now() < end; ++i) {
    Try(mutator.Make(options.first + i), trace);
  }
}

// How the child ended: its wait status, or nothing if it had to be stopped because of a hang.
std::optional<int> Await(pid_t child, const Trace& trace) {
  std::uint64_t seen = 0;
  auto since = Clock::now();
  int status = 0;
  while (waitpid(child, &status, WNOHANG) == 0) {
    std::this_thread::sleep_for(kPoll);
    if (trace.done != seen) {
      seen = trace.done;
      since = Clock::now();
    } else if (Clock::now() - since > kHangs) {
      kill(child, SIGKILL);
      waitpid(child, &status, 0);
      return std::nullopt;
    }
  }
  return status;
}

std::string Describe(const std::optional<int>& status) {
  if (!status) return "hangs";
  if (WIFSIGNALED(*status)) return std::string("dies of ") + strsignal(WTERMSIG(*status));
  return "ends with exit code " + std::to_string(WEXITSTATUS(*status));
}

void ReportFailure(const Options& options, const Trace& trace, const std::optional<int>& status) {
  const char* const target = options.target.c_str();
  if (!options.files.empty()) {
    const std::size_t at = std::min<std::size_t>(trace.done, options.files.size() - 1);
    std::fprintf(stderr, "%s: %s with %s\n", target, Describe(status).c_str(),
                 options.files[at].c_str());
    return;
  }
  const std::uint64_t number = options.first + trace.done;
  const std::string file = options.folder + "/" + options.target + "-" +
                           std::to_string(options.seed) + "-" + std::to_string(number) + ".input";
  std::ofstream(file, std::ios::binary)
      .write(trace.input, static_cast<std::streamsize>(trace.bytes.load()));
  std::fprintf(stderr,
               "%s: %s at iteration %llu of seed %llu; the input is in %s\n"
               "again: %s %s\n",
               target, Describe(status).c_str(), static_cast<unsigned long long>(number),
               static_cast<unsigned long long>(options.seed), file.c_str(), target, file.c_str());
}

int Run(const Options& options) {
  Trace* const trace = SharedTrace();
  const auto began = Clock::now();
  std::fflush(nullptr);
  const pid_t child = fork();
  GIVEWAY_CHECK(child >= 0, std::strerror(errno));
  if (child == 0) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    TryAll(options, trace);
    std::exit(0);  // and not _exit: leaks are checked on exit
  }
  const std::optional<int> status = Await(child, *trace);
  if (status != 0) {
    ReportFailure(options, *trace, status);
    return 1;
  }
  const double seconds = std::chrono::duration<double>(Clock::now() - began).count();
  const auto done = static_cast<double>(trace->done);
  std::printf("%s: %.0f inputs in %.1f s, %.0f a second, seed %llu\n", options.target.c_str(), done,
              seconds, done / seconds, static_cast<unsigned long long>(options.seed));
  return 0;
}

int Main(int argc, char** argv) {
  Options options{.target = std::filesystem::path(argv[0]).filename()};
  CLI::App app("Feeds " + options.target +
               " malformed inputs. Exit code 0: it survived all of them; 1: it failed, and stderr "
               "names the file with the input; 2: it could not be run.");
  app.add_option("--seed", options.seed, "which inputs")->capture_default_str();
  app.add_option("--seconds", options.seconds, "for how long")
      ->envname("GIVEWAY_FUZZ_SECONDS")
      ->check(CLI::Range(0.0, 1e7))
      ->capture_default_str();
  app.add_option("--inputs", options.inputs, "how many, whatever the time; 0: by time")
      ->capture_default_str();
  app.add_option("--first", options.first, "number of the first one")->capture_default_str();
  app.add_option("--folder", options.folder, "where a failing input is written")
      ->check(CLI::ExistingDirectory)
      ->capture_default_str();
  app.add_option("FILE", options.files, "inputs to try instead, once each")
      ->check(CLI::ExistingFile);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  return Run(options);
}

}  // namespace
}  // namespace giveway::fuzz

int main(int argc, char** argv) { return giveway::fuzz::Main(argc, argv); }
