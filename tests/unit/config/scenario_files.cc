#include "tests/unit/config/scenario_files.h"

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "services/config/problem.h"
#include "services/config/scenario_file.h"
#include "services/types/check.h"

namespace giveway {

TempFolder::TempFolder() {
  std::string pattern = (std::filesystem::temp_directory_path() / "giveway_unit_XXXXXX").string();
  GIVEWAY_CHECK(mkdtemp(pattern.data()) != nullptr, pattern);
  path_ = pattern;
}

TempFolder::~TempFolder() { std::filesystem::remove_all(path_); }

std::string TempFolder::Write(const std::string& name, std::string_view text) const {
  const std::string file = path_ + "/" + name;
  std::ofstream(file, std::ios::binary) << text;
  return file;
}

const std::string kGoodScenario = R"(name: "two"
crossing { x_m: 0 y_m: 0 }
vehicle {
  id: 1
  start { x_m: -4 y_m: 0 heading_deg: 0 }
  cruise_m_s: 0.4
  goal { x_m: 2 y_m: 0 }
}
vehicle {
  id: 2
  start { x_m: 0 y_m: -3 heading_deg: 90 }
  cruise_m_s: 0.3
}
wall { from { x_m: -5 y_m: 3 } to { x_m: 5 y_m: 3 } }
fault { kill: 2 at_s: 4 }
expect { arrived: [1] }
)";

std::string Edited(std::string_view from, std::string_view to) {
  std::string text = kGoodScenario;
  const std::size_t at = text.find(from);
  GIVEWAY_CHECK(at != std::string::npos && text.find(from, at + 1) == std::string::npos, from);
  return text.replace(at, from.size(), to);
}

Scenario Load(const std::string& text, const ScenarioOverrides& overrides) {
  const TempFolder folder;
  return LoadScenario(folder.Write("s.textproto", text), overrides);
}

std::vector<Problem> ProblemsOf(const std::string& text, const ScenarioOverrides& overrides) {
  try {
    Load(text, overrides);
  } catch (const InputError& error) {
    return error.Problems();
  }
  return {};
}

}  // namespace giveway
