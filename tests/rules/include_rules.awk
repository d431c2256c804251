# Reads modules.txt and then sources. Prints lines of three kinds:
#   violation FILE: what
#   module FROM TO, file FROM TO    arrows of includes, for tsort; a .h and its .cc are one file
BEGIN {
  LONGEST_FILE = 500
  MOST_FILES = 40
  # Standard headers the pure modules do without: threads, wall clocks, files, and standard
  # streams, which they never write to.
  IMPURE = "^(thread|mutex|shared_mutex|atomic|condition_variable|future|semaphore|latch|barrier|" \
           "stop_token|coroutine|filesystem|fstream|iostream|ctime|random|time\\.h|csignal)$"
  # These differ from one C library or CPU to the next; services/types/math has its own.
  INEXACT = "std::(sin|cos|tan|asin|acos|atan|atan2|exp|exp2|expm1|log|log2|log10|log1p|pow|hypot|cbrt)\\("
  # Which library a header belongs to, by the start of its name.
  n = split("fastdds/ fastrtps/ fastcdr/ fleet idl/ google/protobuf/ spdlog/ httplib.h prometheus/ CLI/ " \
            "tinyxml2.h yaml-cpp/ Eigen/ immintrin.h openssl/ lz4 boost/asio boost/beast boost/math nlohmann/ utf8.h", prefixes, " ")
  split("fastdds fastdds fastdds fastdds fastdds protobuf spdlog httplib prometheus CLI " \
        "tinyxml2 yaml-cpp Eigen immintrin openssl lz4 beast beast boost.math nlohmann utfcpp", libraries, " ")
}

function violation(text) { print "violation " FILENAME ": " text }

# The listed folder that holds the path; "tests" and "" are none of the table's.
function module_of(path,   folder) {
  folder = path
  while (sub(/\/[^\/]*$/, "", folder)) {
    if (folder in kind) return folder
  }
  return path ~ /^tests\// ? "tests" : ""
}

function component_of(path) {
  sub(/\.(h|cc|inc)$/, "", path)
  return path
}

function library_of(header,   i) {
  if (header ~ /\.pb\.h$/) return "protobuf"
  for (i = 1; i <= n; ++i) {
    if (index(header, prefixes[i]) == 1) return libraries[i]
  }
  return ""
}

function check_own_header(header,   to) {
  to = module_of(header)
  if (to != module && module != "tests") {
    if (!((module, to) in may_see)) violation("\"" header "\": no arrow from " module " to there")
    else print "module " module " " to
  }
  if (module != "tests" && component_of(header) != component) {
    print "file " component " " component_of(header)
  }
}

function check_foreign_header(header,   library, own_files) {
  if (module == "tests") return
  library = library_of(header)
  if (library != "") {
    own_files = may_use[module, library]
    if (own_files == "" || (own_files != "any" && index(own_files, "," name ",") == 0)) {
      violation("<" header ">: not for this file (modules.txt)")
    }
    return
  }
  if (kind[module] != "pure") return
  if (header ~ IMPURE) violation("<" header ">: " module " is pure")
  else if (header ~ /\/|\.h$/) violation("<" header ">: " module " uses the standard library alone")
}

function end_of_file() {
  if (path != "" && lines > LONGEST_FILE) {
    print "violation " path ": " lines " lines; more than " LONGEST_FILE " are more than one idea"
  }
}

# The table. `a(b,c)` is library a for the files b and c alone.
FILENAME ~ /modules\.txt$/ {
  if (/^#/ || NF == 0) next
  split($0, part, / *\| */)
  kind[part[1]] = part[2]
  count = split(part[3], seen, " ")
  for (i = 1; i <= count; ++i) may_see[part[1], seen[i]] = 1
  count = split(part[4], used, " ")
  for (i = 1; i <= count; ++i) {
    library = used[i]
    own_files = "any"
    if (match(library, /\(.*\)/)) {
      own_files = "," substr(library, RSTART + 1, RLENGTH - 2) ","
      library = substr(library, 1, RSTART - 1)
    }
    may_use[part[1], library] = own_files
  }
  next
}

FNR == 1 {
  end_of_file()
  path = FILENAME
  module = module_of(path)
  component = component_of(path)
  name = path
  sub(/.*\//, "", name)
  folder = substr(path, 1, length(path) - length(name) - 1)
  if (module == "") violation("belongs to no module (modules.txt)")
  if (path ~ /(^|\/|_)(utils?|common|helpers?|managers?)(\/|_|\.)/) {
    violation("named after nothing; name the idea")
  }
  if (++files_in[folder] == MOST_FILES + 1) {
    violation("the folder has more than " MOST_FILES " sources: more than one idea")
  }
}

{ lines = FNR }

/^[ \t]*#[ \t]*include[ \t]*["<]/ {
  header = $0
  sub(/^[ \t]*#[ \t]*include[ \t]*["<]/, "", header)
  sub(/[">].*/, "", header)
  if (header ~ /^(services|sim_world)\// && module_of(header) != "") check_own_header(header)
  else if (header ~ /^tests\// && module != "tests") violation("\"" header "\": a test's")
  else check_foreign_header(header)
  next
}

kind[module] == "pure" && /_clock::now/ { violation("reads a clock: time is an argument in " module) }
kind[module] ~ /^(pure|exact)$/ && $0 ~ INEXACT {
  violation("a C library function whose bits differ by CPU: see services/types/math/math.h")
}
# A read that fails throws there, past the state of the stream: of a process that ended, of a bad disk.
path !~ /^tests\// && /istreambuf_iterator|rdbuf\(\)/ { violation("reads past the stream, which throws") }
path ~ /^tests\/unit\// && /sleep_for|sleep_until|usleep/ { violation("a unit test sleeps") }

END { end_of_file() }
