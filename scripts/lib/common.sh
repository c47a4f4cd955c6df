# shellcheck shell=bash
# Shared by the scripts in the folder above, which source it after `set -euo pipefail`. It changes to
# the root of the project.

cd "$(dirname "${BASH_SOURCE[0]}")/../.." || exit

say() { printf -- '-- %s\n' "$*"; }

fail() {
  printf 'error: %s\n' "$*" >&2
  exit 2
}

# Runs a command with its output kept back, and shows the end of the output if it fails.
quietly() {
  local log
  log=$(mktemp)
  if ! "$@" >"$log" 2>&1; then
    tail -n 40 "$log" >&2
    rm -f "$log"
    printf 'error: this failed: %s\n' "$*" >&2
    return 1
  fi
  rm -f "$log"
}

listed_packages() { sed '/^#/d' scripts/lib/packages; }

missing_packages() {
  # dpkg-query complains about, and fails for, packages it has never heard of. It fills in the
  # variables of its format itself.
  # shellcheck disable=SC2016
  comm -23 <(listed_packages | LC_ALL=C sort) \
    <(listed_packages | xargs dpkg-query -W -f '${Package} ${db:Status-Status}\n' 2>/dev/null |
      sed -n 's/ installed$//p' | LC_ALL=C sort -u)
}

# npm comes with other packages of Node.js, too, beside which Debian's npm cannot be installed.
missing_commands() {
  command -v npm >/dev/null || printf '%s\n' nodejs npm
}

is_debian_12() {
  [[ -r /etc/os-release ]] &&
    (. /etc/os-release && [[ ${ID:-} == debian && ${VERSION_ID:-} == 12 ]])
}

as_root() {
  if [[ $(id -u) == 0 ]]; then
    "$@"
  else
    sudo "$@"
  fi
}

# Installs the Debian packages that are not there yet. Other systems are told what is needed; there
# CMake finds out whether they have it.
install_packages() {
  if ! is_debian_12; then
    if [[ ! -d build ]]; then
      say "not Debian 12: these packages must be there, under whatever name:"
      { listed_packages; printf '%s\n' nodejs npm; } | paste -sd ' ' | fold -s -w 96
    fi
    return
  fi
  local missing=()
  mapfile -t missing < <(missing_packages; missing_commands)
  if [[ ${#missing[@]} == 0 ]]; then return; fi
  if [[ $(id -u) != 0 ]] && ! command -v sudo >/dev/null; then
    fail "packages are missing and there is no sudo. As root: apt-get install ${missing[*]}"
  fi
  say "installing ${#missing[@]} packages, which may take some minutes: ${missing[*]}"
  quietly as_root apt-get -q update
  quietly as_root env DEBIAN_FRONTEND=noninteractive \
    apt-get -q -y --no-install-recommends install "${missing[@]}"
}

# build_preset PRESET
build_preset() {
  local preset=$1
  local ninja_file=build/$preset/build.ninja
  if command -v ccache >/dev/null; then export CMAKE_CXX_COMPILER_LAUNCHER=ccache; fi
  # Ninja sees by itself when a CMakeLists.txt has changed, but does not know of the presets.
  if [[ ! -e $ninja_file || CMakePresets.json -nt $ninja_file ]]; then
    say "configuring build/$preset"
    quietly cmake --preset "$preset"
  fi
  say "building build/$preset"
  local ninja_options=()
  if [[ ! -t 1 ]]; then ninja_options=(-- --quiet); fi
  cmake --build --preset "$preset" -j "${CMAKE_BUILD_PARALLEL_LEVEL:-$(nproc)}" \
    "${ninja_options[@]}"
}
