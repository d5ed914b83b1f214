#!/usr/bin/env bash
# Sets vmech up on Debian 12: installs the missing packages, configures, builds. See usage() below.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"

usage() {
  cat <<'END'
Usage: ./setup.sh COMMAND

  demo              build the vmech command and run the bearing-load study of a slider-crank
  test              build everything and run every test
  packages GROUP... install the groups of packages.txt: core, cad, doors, tests,
                    tools, docs, optional
  help              show this text

Missing Debian packages are installed first, as root or through sudo; nothing else is downloaded.
The number of parallel jobs is that of the processors, or CMAKE_BUILD_PARALLEL_LEVEL.
END
}

die() {
  echo "setup.sh: $*" >&2
  exit 1
}

as_root() {
  if [[ $EUID -eq 0 ]]; then
    "$@"
  elif command -v sudo >/dev/null; then
    sudo "$@"
  else
    die "installing packages needs root: run as root, install sudo, or run: $*"
  fi
}

# The packages of one group: the lines between its heading '# group: ...' and the next heading.
packages_of() {
  awk -v group="$1" '/^# [a-z]+: / { inside = ($2 == group ":") } /^[^#]/ && inside' packages.txt
}

# Those of the given packages that are not installed.
missing_among() {
  local package
  for package in "$@"; do
    [[ $(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null) == installed ]] ||
      echo "$package"
  done
}

install_packages() {
  local group packages=() missing
  for group in "$@"; do
    [[ -n $(packages_of "$group") ]] || die "packages.txt has no group '$group'"
    mapfile -t -O "${#packages[@]}" packages < <(packages_of "$group")
  done
  command -v dpkg-query >/dev/null ||
    die "this is not a Debian system; install what packages.txt lists and use CMakePresets.json"
  mapfile -t missing < <(missing_among "${packages[@]}")
  [[ ${#missing[@]} -gt 0 ]] || return 0

  echo "Installing: ${missing[*]}"
  export DEBIAN_FRONTEND=noninteractive
  apt-get install --simulate --no-install-recommends "${missing[@]}" >/dev/null 2>&1 ||
    as_root apt-get update -q
  as_root apt-get install -q -y --no-install-recommends "${missing[@]}" ||
    die "apt-get could not install the packages; run apt-get update and try again"
}

run_demo() {
  local build=build/demo report_dir=out/slider-crank
  install_packages core
  # For one study, what a better optimised command would save is less than its compilation costs.
  cmake --preset release -B "$build" -DCMAKE_CXX_FLAGS_RELEASE="-O1 -DNDEBUG" \
    -DVMECH_PRECOMPILE=ON -DVMECH_BUILD_TESTS=OFF -DVMECH_BUILD_NOTEBOOKS=OFF
  cmake --build "$build" --target vmech_command
  "$build/apps/vmech" loads mechanisms/examples/slider-crank-study.yaml --out "$report_dir"
  echo "The report is $PWD/$report_dir/report.html"
}

run_tests() {
  install_packages core cad doors tests tools docs
  cmake --preset dev -DVMECH_REQUIRE_PACKAGES=ON -DVMECH_PRECOMPILE=ON -DVMECH_BATCHES=ON
  cmake --build --preset dev
  ctest --preset dev
}

CMAKE_BUILD_PARALLEL_LEVEL=${CMAKE_BUILD_PARALLEL_LEVEL:-$(nproc)}
CTEST_PARALLEL_LEVEL=${CTEST_PARALLEL_LEVEL:-$CMAKE_BUILD_PARALLEL_LEVEL}
export CMAKE_BUILD_PARALLEL_LEVEL CTEST_PARALLEL_LEVEL

case "${1:-help}" in
  demo) run_demo ;;
  test) run_tests ;;
  packages)
    [[ $# -gt 1 ]] ||
      die "packages: name one or more of core, cad, doors, tests, tools, docs, optional"
    install_packages "${@:2}"
    ;;
  help | -h | --help) usage ;;
  *)
    usage >&2
    die "unknown command '$1'"
    ;;
esac
