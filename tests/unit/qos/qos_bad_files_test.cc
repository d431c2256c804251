// One seeded mistake a file, in bad_qos/. Comments at its top say what must be found, and in which
// deployment:
//   EXPECT rule [:line]   each rule that is broken, and no other may be
//   FLEET n, TICK_MS n    how large it is and how often it speaks
//   ENVIRONMENT, FOLDER   a variable that is set, a file that is in the folder
//   COMPLETE              the file claims to be a whole set
#include <gmock/gmock.h>

#include <optional>
#include <sstream>

#include "services/qos/profile_check.h"
#include "tests/unit/qos/qos_files.h"

namespace giveway::qos {
namespace {

namespace fs = std::filesystem;

struct Case {
  Deployment deployment{.complete = false};
  std::vector<std::string> rules;
  std::optional<int> line;  // of the last rule that names one
};

void Understand(const std::string& key, std::istringstream& rest, Case* to) {
  std::string word;
  rest >> word;
  if (key == "EXPECT") {
    to->rules.push_back(word);
    if (rest >> word && word.front() == ':') to->line = std::stoi(word.substr(1));
  } else if (key == "FLEET") {
    to->deployment.vehicles = std::stoi(word);
  } else if (key == "TICK_MS") {
    to->deployment.tick_ns = std::stoi(word) * 1'000'000;
  } else if (key == "ENVIRONMENT") {
    to->deployment.environment.push_back(word);
  } else if (key == "FOLDER") {
    to->deployment.folder_files.push_back(word);
  } else if (key == "COMPLETE") {
    to->deployment.complete = true;
  } else {
    ADD_FAILURE() << "unknown word " << key;
  }
}

Case CaseIn(const std::string& bytes) {
  Case found;
  std::istringstream lines(bytes);
  std::string line;
  while (std::getline(lines, line) && line.starts_with("<!-- ")) {
    std::istringstream words(line.substr(5));
    std::string key;
    words >> key;
    Understand(key, words, &found);
  }
  std::ranges::sort(found.rules);
  return found;
}

std::vector<std::string> RulesOf(const Findings& findings) {
  std::vector<std::string> rules;
  for (const Finding& finding : findings) rules.push_back(finding.rule);
  std::ranges::sort(rules);
  rules.erase(std::unique(rules.begin(), rules.end()), rules.end());
  return rules;
}

std::vector<fs::path> BadFiles() { return XmlFilesIn(GIVEWAY_BAD_QOS); }

class BadQos : public ::testing::TestWithParam<fs::path> {};

TEST_P(BadQos, IsFoundByTheRuleItNamesAndByNoOther) {
  const std::string bytes = BytesOf(GetParam());
  const Case expected = CaseIn(bytes);
  ASSERT_FALSE(expected.rules.empty());
  const std::string name = GetParam().filename();
  const Findings findings = Check({{name, bytes}}, expected.deployment);
  EXPECT_EQ(RulesOf(findings), expected.rules);
  for (const Finding& finding : findings) {
    EXPECT_EQ(finding.place.line, expected.line.value_or(finding.place.line)) << finding.rule;
    EXPECT_FALSE(finding.values.empty()) << finding.rule;
    EXPECT_THAT(finding.consequence, ::testing::EndsWith(".")) << finding.rule;
    EXPECT_FALSE(finding.remedy.empty()) << finding.rule;
  }
  EXPECT_NE(ExitCode(findings), 0);
}

std::string StemOf(const ::testing::TestParamInfo<fs::path>& file) { return file.param.stem(); }

INSTANTIATE_TEST_SUITE_P(Files, BadQos, ::testing::ValuesIn(BadFiles()), StemOf);

TEST(BadQosFiles, AreAtLeastForty) { EXPECT_GE(BadFiles().size(), 40U); }

}  // namespace
}  // namespace giveway::qos
