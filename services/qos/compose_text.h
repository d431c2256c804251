// The variables of a compose file, and what its texts are once they are put in. Knows no YAML.
#pragma once

#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace giveway::qos {

// NAME=value of each line of a `.env` file: comments, blank lines and `export` left out, quotes
// taken off.
std::vector<std::string> EnvFileVariables(std::string_view bytes);

// Expands $NAME, ${NAME}, ${NAME:-otherwise}, ${NAME-otherwise}, ${NAME:+instead},
// ${NAME+instead}, ${NAME:?why} and ${NAME?why} as compose does, each also within the words of
// another, and $$.
class ComposeText {
 public:
  // `variables` are NAME=value, the first of a name counts; they outlive this.
  explicit ComposeText(const std::vector<std::string>& variables) : variables_(variables) {}

  // nullptr if it is not set; else what is behind "NAME=".
  const char* Variable(std::string_view name) const;
  std::string Expanded(std::string_view text);
  // Those that an expansion required, and that are not set.
  const std::set<std::string>& Missing() const { return missing_; }

 private:
  std::string Expanded(std::string_view text, int depth);
  std::string ValueOf(std::string_view inner, int depth);

  const std::vector<std::string>& variables_;
  std::set<std::string> missing_;
};

}  // namespace giveway::qos
