# shellcheck shell=bash
# The set-up both services/run.sh and tests/run.sh stand on: Debian packages, configuration, build.
# Sourced, never run. Every step says what it does, does nothing if nothing is to be done, and
# names what failed.

GIVEWAY_ROOT=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)

say() { printf '== %s\n' "$*" >&2; }

# Exit code 2: it could not run.
die() {
  printf 'error: %s\n' "$*" >&2
  exit 2
}

debian_version() {
  # shellcheck source=/dev/null
  (. /etc/os-release 2>/dev/null && printf '%s' "${VERSION_ID:-0}")
}

# Debian 13 renamed the library with its third major version. gnuplot draws the pictures of
# fleetctl qos tune, which does without where it is missing.
build_packages() {
  local fastdds=libfastrtps-dev
  [[ $(debian_version) -ge 13 ]] 2>/dev/null && fastdds=libfastdds-dev
  printf '%s\n' git g++ cmake ninja-build ccache "$fastdds" fastddsgen \
    libprotobuf-dev protobuf-compiler libspdlog-dev libfmt-dev libcli11-dev libboost-dev libeigen3-dev \
    nlohmann-json3-dev libutfcpp-dev libtinyxml2-dev libyaml-cpp-dev liblz4-dev libssl-dev pkgconf \
    libcpp-httplib-dev prometheus-cpp-dev gnuplot-nox \
    libgtest-dev libgmock-dev librapidcheck-dev libbenchmark-dev
}

# What the built programs need, by the names that each Debian gives its libraries.
runtime_packages() {
  if [[ $(debian_version) -ge 13 ]]; then
    printf '%s\n' libfastdds3.1 libfastcdr2 libprotobuf32t64 libspdlog1.15 libfmt10 libtinyxml2-11 \
      libyaml-cpp0.8 liblz4-1 libssl3t64 libcpp-httplib0.18 libprometheus-cpp-core1.0
  else
    printf '%s\n' libfastrtps2.9 libfastcdr1 libprotobuf32 libspdlog1.10 libfmt9 libtinyxml2-9 \
      libyaml-cpp0.7 liblz4-1 libssl3 libcpp-httplib0.11 libprometheus-cpp-core1.0
  fi
}

# What the image of fleetctl has in addition to those: the discovery server.
tools_packages() { printf '%s\n' fastdds-tools; }

# fastddsgen is a Java program: without a working Java it writes nothing, and says little. Any
# Java will do.
java_package() { java -version >/dev/null 2>&1 || echo default-jre-headless; }

# Any Node.js with npm will do, too: for what checks the manifests of Kubernetes.
node_packages() { command -v npm >/dev/null || printf '%s\n' nodejs npm; }

# The browser of the stage web, and the font of its screenshots.
web_packages() { printf '%s\n' chromium fonts-dejavu-core; }

test_packages() {
  local clang_rt=libclang-rt-14-dev
  [[ $(debian_version) -ge 13 ]] 2>/dev/null && clang_rt=libclang-rt-19-dev
  printf '%s\n' clang-format iproute2 jq shellcheck librsvg2-bin spin clang clang-tidy "$clang_rt" cyclonedds-dev \
    cyclonedds-tools parallel help2man
  tools_packages
}

# What the world is measured against. Only tests/bench/run.sh asks for them.
bench_packages() { printf '%s\n' libbox2d-dev libembree-dev; }

# What the values of the profile sets are tried with. Only tests/bench/qos_effects.sh asks for them.
effect_packages() { printf '%s\n' jq xmlstarlet fastdds-tools; }

as_root() {
  if [[ $(id -u) -eq 0 ]]; then
    "$@"
  elif command -v sudo >/dev/null; then
    sudo "$@"
  else
    die "installing packages needs root or sudo; as root: apt-get install ${MISSING[*]}"
  fi
}

apt() {
  as_root env DEBIAN_FRONTEND=noninteractive apt-get -o DPkg::Lock::Timeout=300 "$@" </dev/null >&2
}

# Leaves those of the named packages that are not installed in MISSING.
find_missing() {
  local installed package
  installed=$(dpkg-query -W -f='${db:Status-Status} ${Package}\n' "$@" 2>/dev/null || true)
  MISSING=()
  for package in "$@"; do
    grep -qx "installed $package" <<<"$installed" || MISSING+=("$package")
  done
}

install_one_by_one() {
  local package
  for package in "${MISSING[@]}"; do
    apt install -y --no-install-recommends "$package" ||
      die "the Debian package $package could not be installed; apt-get's reason stands above"
  done
}

# Installs what is missing of the named packages.
install_packages() {
  command -v dpkg-query >/dev/null ||
    die "this is not Debian; install by hand what matches these packages: $*"
  find_missing "$@"
  [[ ${#MISSING[@]} -eq 0 ]] && return
  say "installing ${#MISSING[@]} Debian packages: ${MISSING[*]}"
  # Slim images are without it, and there the package of Java cannot be set up.
  [[ -d /usr/share/man/man1 ]] || as_root mkdir -p /usr/share/man/man1
  if ! apt-cache show "${MISSING[@]}" >/dev/null 2>&1; then
    apt update || die "apt-get update failed; apt-get's reason stands above"
  fi
  apt install -y --no-install-recommends "${MISSING[@]}" && return
  # The lists may be out of date, or one package alone may be at fault: then it is named.
  apt update || die "apt-get update failed; apt-get's reason stands above"
  install_one_by_one
}

check_java() {
  local words
  words=$(java -version 2>&1) ||
    die "java does not work: ${words:-it says nothing}; reinstall default-jre-headless"
}

# Compilers of this size want a gigabyte each.
build_jobs() {
  local cores gigabytes
  cores=$(nproc)
  gigabytes=$(awk '/^MemTotal:/ {print int($2 / 1048576)}' /proc/meminfo)
  ((gigabytes < 1)) && gigabytes=1
  echo $((cores < gigabytes ? cores : gigabytes))
}

# alone_in PRESET FUNCTION...: one at a time in a build folder: ninja does not keep two apart.
alone_in() {
  local preset=$1
  shift
  mkdir -p "$GIVEWAY_ROOT/build"
  (
    flock 9
    "$@" 9>&-
  ) 9>"$GIVEWAY_ROOT/build/.$preset.lock" || exit
}

# configure PRESET [CMAKE_ARGUMENTS]: skipped where it is done already; ninja notices changed files.
configure() { alone_in "$1" configure_alone "$@"; }
configure_alone() {
  local preset=$1 folder="$GIVEWAY_ROOT/build/$1" fresh=()
  shift
  local wanted="$GIVEWAY_ROOT $*"
  if [[ -f $folder/build.ninja && $(cat "$folder/.configured_as" 2>/dev/null) == "$wanted" ]]; then
    return
  fi
  # A folder configured for another place cannot be used again.
  if [[ -f $folder/CMakeCache.txt ]] &&
    ! grep -qx "CMAKE_HOME_DIRECTORY:INTERNAL=$GIVEWAY_ROOT" "$folder/CMakeCache.txt"; then
    fresh=(--fresh)
  fi
  say "configuring $preset"
  (cd "$GIVEWAY_ROOT" && cmake "${fresh[@]}" --preset "$preset" "$@" >&2) ||
    die "cmake could not configure the preset $preset; its reason stands above"
  printf '%s\n' "$wanted" >"$folder/.configured_as"
}

# build PRESET [TARGETS]
build() { alone_in "$1" build_alone "$@"; }
build_alone() {
  local preset=$1 targets=()
  shift
  [[ $# -gt 0 ]] && targets=(--target "$@")
  say "building $preset"
  cmake --build "$GIVEWAY_ROOT/build/$preset" --parallel "$(build_jobs)" "${targets[@]}" >&2 ||
    die "the build of $preset failed; the first line with FAILED above names the file"
}
