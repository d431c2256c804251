#!/usr/bin/env bash
# Injects one defect at a time in a unit of two files and a header, compiled as a module is: each is a
# finding of the check that is named, and without it there is none. What passed is not checked again;
# what failed, or had another comment or other checks then, is.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
tree=$(mktemp -d)
trap 'rm -rf "$tree"' EXIT
failures=0
fail() {
  printf '%s\n' "$*"
  failures=$((failures + 1))
}

# Counts what is really checked.
mkdir -p "$tree"/{bin,tests/tidy,services/unit,build/tidy/services/unit}
cat >"$tree/bin/clang-tidy" <<TEXT
#!/usr/bin/env bash
echo >>"$tree/checked"
exec $(command -v clang-tidy) "\$@"
TEXT
chmod +x "$tree/bin/clang-tidy"
cp "$root/.clang-tidy" "$tree"
cp "$root/tests/tidy/check_unit.sh" "$tree/tests/tidy"
mapfile -t launcher < <(jq -r --arg tree "$tree" '.configurePresets[] | select(.name == "tidy")
  | .cacheVariables.CMAKE_CXX_COMPILER_LAUNCHER | gsub("\\$\\{sourceDir\\}"; $tree) | split(";")[]' \
  "$root/CMakePresets.json")
export PATH=$tree/bin:$PATH CCACHE_DIR=$tree/cache CCACHE_BASEDIR=$tree CCACHE_NOHASHDIR=1

# write FILE TEXT, and the headers that all of them need.
write() { printf '%s\n' '#include <memory>' '#include <string>' '#include <vector>' "$2" >"$tree/services/unit/$1"; }
lay_out() {
  write values.h '#pragma once
inline std::size_t Length(const std::string& name) { return name.size(); }'
  write first.cc '#include "services/unit/values.h"
std::size_t First(const std::string& name) { return Length(name); }'
  write second.cc '#include "services/unit/values.h"
std::size_t Second(const std::string& name) { return Length(name) + 1; }'
  printf '#include "%s"\n' "$tree"/services/unit/{first,second}.cc >"$tree/build/tidy/services/unit/unity_0_cxx.cxx"
}

# As ninja compiles a unit: its exit code, what it prints in the file report.
check_unit() {
  : >"$tree/checked"
  (cd "$tree/build/tidy" && "${launcher[@]}" clang++ -I"$tree" -std=c++20 -MD -MT unit.o -MF services/unit/unit.o.d \
    -o services/unit/unit.o -c "$tree/build/tidy/services/unit/unity_0_cxx.cxx" >"$tree/report" 2>&1)
}

# expect_pass CHECKED WHAT: the unit passes, and clang-tidy was started so many times.
expect_pass() {
  local code=0
  check_unit || code=$?
  [[ $code -eq 0 ]] || fail "$2: found $(<"$tree/report")"
  [[ $(wc -l <"$tree/checked") -eq $1 ]] || fail "$2: checked $(wc -l <"$tree/checked") times, not $1"
}

# expect_finding CHECK FILE: in that file, again when repeated, and nothing in the others.
expect_finding() {
  local code=0
  for _ in 1 2; do
    check_unit || code=$?
    if [[ $code -eq 0 ]] || grep 'error: ' "$tree/report" | grep -qv "services/unit/$2:" ||
      ! grep -q "services/unit/$2:.*error: .*\[$1,-warnings-as-errors\]" "$tree/report"; then
      fail "$1 in $2 is not found: $(<"$tree/report")"
    fi
  done
}

# expect_caught CHECK FILE TEXT: the text in the file in place of what is there.
expect_caught() {
  lay_out
  write "$2" "$3"
  expect_finding "$1" "$2"
}

lay_out
expect_pass 1 "a clean unit"
expect_pass 0 "a clean unit for the second time"
grep -q 'services/unit/values.h' "$tree/build/tidy/services/unit/unit.o.d" || fail "ninja does not know of values.h"

expect_caught bugprone-use-after-move second.cc '
std::size_t Second(std::string name) {
  const std::string kept = std::move(name);
  return kept.size() + name.size();
}'
expect_caught bugprone-implicit-widening-of-multiplication-result first.cc '
std::size_t First(unsigned rows, unsigned columns) { return rows * columns; }'
expect_caught clang-analyzer-core.NullDereference second.cc '
int Second(const int* value) { return value == nullptr ? *value : 0; }'
expect_caught performance-for-range-copy first.cc '
std::size_t First(const std::vector<std::string>& names) {
  std::size_t length = 0;
  for (const std::string name : names) length += name.size();
  return length;
}'
expect_caught bugprone-sizeof-expression values.h '#pragma once
inline std::size_t Length(const std::string& name) { return name.size() + sizeof(&name); }'

# A comment alone decides here, and the checks there.
lay_out
write second.cc '
int Second(const int* value) {
  return value == nullptr ? *value : 0;  // NOLINT(clang-analyzer-core.NullDereference): a test
}'
expect_pass 1 "a finding with NOLINT"
sed -i 's,  // NOLINT.*,,' "$tree/services/unit/second.cc"
expect_finding clang-analyzer-core.NullDereference second.cc
sed -i '/clang-analyzer-core/d' "$tree/.clang-tidy"
expect_pass 1 "without the check"

[[ $failures -eq 0 ]]
