// Help of the command line: the verb or flag that was probably meant, and completion.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <CLI/CLI.hpp>

#include "services/fleetctl/help/completion.h"
#include "services/fleetctl/help/help_verbs.h"
#include "services/fleetctl/help/usage_error.h"

namespace giveway::fleetctl {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

class HelpTest : public testing::Test {
 protected:
  HelpTest() {
    app_.require_subcommand(1);
    CLI::App* run = app_.add_subcommand("run", "Run");
    run->add_option("--vehicles", number_, "How many");
    run->add_option("--log-level", text_, "Of the log")->check(CLI::IsMember({"debug", "info"}));
    run->add_flag("--lockstep", lockstep_, "Wait");
    CLI::App* qos = app_.add_subcommand("qos", "QoS");
    qos->require_subcommand(1);
    qos->add_subcommand("check", "Check");
    qos->add_subcommand("show", "Show");
    app_.add_subcommand("complete", "")->group("");
  }

  std::string Refusal(const std::string& line) {
    try {
      app_.parse(line);
    } catch (const CLI::ParseError& error) {
      return ExplainUsageError(app_, error);
    }
    return "accepted";
  }

  CLI::App app_{"Fleets", "fleetctl"};
  int number_ = 0;
  bool lockstep_ = false;
  std::string text_;
};

TEST_F(HelpTest, AVerbThatIsAlmostOneIsNamed) {
  EXPECT_THAT(Refusal("rum"), HasSubstr("no verb 'rum'; did you mean 'run'?"));
  EXPECT_THAT(Refusal("qos chekc"), HasSubstr("no verb 'chekc'; did you mean 'check'?"));
}

TEST_F(HelpTest, AllVerbsAreListedButThoseForPrograms) {
  EXPECT_THAT(Refusal("zebra"), HasSubstr("verbs: run, qos"));
  EXPECT_THAT(Refusal("zebra"), Not(HasSubstr("complete")));
  EXPECT_THAT(Refusal(""), HasSubstr("a verb is missing"));
}

TEST_F(HelpTest, AFlagThatIsAlmostOneIsNamed) {
  EXPECT_EQ(Refusal("run --vehicels 3"),
            "fleetctl run has no flag --vehicels; did you mean '--vehicles'?");
  EXPECT_EQ(Refusal("run --lock-step=1"),
            "fleetctl run has no flag --lock-step; did you mean '--lockstep'?");
  EXPECT_EQ(Refusal("run --zebra"), "fleetctl run has no flag --zebra");
}

TEST_F(HelpTest, VerbsAreCompleted) {
  EXPECT_THAT(Completions(app_, {""}), ElementsAre("qos", "run"));
  EXPECT_THAT(Completions(app_, {"qos", ""}), ElementsAre("check", "show"));
  EXPECT_THAT(Completions(app_, {"qos", "ch"}), ElementsAre("check"));
}

TEST_F(HelpTest, FlagsAndTheirValuesAreCompleted) {
  EXPECT_THAT(Completions(app_, {"run", "--lo"}), ElementsAre("--lockstep", "--log-level"));
  EXPECT_THAT(Completions(app_, {"run", "--log-level", ""}), ElementsAre("debug", "info"));
  EXPECT_THAT(Completions(app_, {"run", "--vehicles", ""}), IsEmpty());
}

class CompletionVerb : public testing::Test {
 protected:
  CompletionVerb() { AddHelpVerbs(&app_, "1", &exit_code_); }

  CLI::App app_{"Fleets", "fleetctl"};
  int exit_code_ = -1;
};

// The word was once parsed into a string that no longer existed, which the address sanitizer
// alone sees.
TEST_F(CompletionVerb, TheShellIsNotWrittenToMemoryThatWasFreed) {
  app_.parse("completion bash");
  EXPECT_EQ(exit_code_, 0);
}

TEST_F(CompletionVerb, AnUnknownShellOrNoneIsRefused) {
  EXPECT_THROW(app_.parse("completion fish"), CLI::ValidationError);
  EXPECT_THROW(app_.parse("completion"), CLI::RequiredError);
  EXPECT_EQ(exit_code_, -1);
}

}  // namespace
}  // namespace giveway::fleetctl
