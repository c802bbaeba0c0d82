#!/usr/bin/env bash
# Installs what is missing, builds everything, runs every test, and fuzzes the readers for a moment.
# Options go to ctest, and then there is no fuzzing: scripts/test.sh -R pipeline
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

scripts/install_packages.sh
echo "Building everything into build/release"
cmake --preset release -DBNVPL_TESTS=ON -DBNVPL_BENCH=ON
cmake --build --preset release
ctest --preset release "$@"
if (($# == 0)); then scripts/fuzz.sh; fi
