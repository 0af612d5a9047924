#!/usr/bin/env bash
# All checks of the project. Sets up what it needs on Debian or Ubuntu; needs Rust and nothing else.
set -euo pipefail
cd "$(dirname "$0")"

step() { printf '\n== %s\n' "$1"; }

install() { # PACKAGE...
  local root=()
  if [ "$(id -u)" -ne 0 ]; then
    if ! command -v sudo >/dev/null; then
      echo "test.sh: $* must be installed; run as root: apt-get install $*" >&2
      exit 1
    fi
    root=(sudo)
  fi
  if ! command -v apt-get >/dev/null; then
    echo "test.sh: $* must be installed, and this system has no apt-get; install it and run again" >&2
    exit 1
  fi
  "${root[@]}" apt-get update -qq
  "${root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq "$@" >/dev/null
}

step "set-up"
has() { compgen -G "$1" >/dev/null; }
if ! has '/usr/share/vulkan/icd.d/*.json' && ! has '/etc/vulkan/icd.d/*.json'; then
  echo "no Vulkan driver: installing the software driver (mesa-vulkan-drivers)"
  install mesa-vulkan-drivers
fi
command -v python3 >/dev/null || install python3
command -v cc >/dev/null || install gcc libc6-dev

step "formatting"
cargo fmt --check

step "lints"
cargo clippy --quiet --all-targets -- -D warnings

step "molecules and meshes are what their scripts make"
python3 molecules/make.py --check
python3 -B meshes/make.py --check

step "tests"
RESTYLE_GPU=required cargo test --quiet

step "documentation"
RUSTDOCFLAGS="-D warnings" cargo doc --quiet --no-deps --document-private-items

printf '\nAll checks passed.\n'
