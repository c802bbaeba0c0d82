#!/usr/bin/env bash
# Installs what is missing, builds everything, and runs every test. Options go to ctest:
# scripts/test.sh -R pipeline
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

scripts/install_packages.sh
echo "Building everything into build/release"
cmake --preset release -DBNVPL_TESTS=ON -DBNVPL_BENCH=ON
cmake --build --preset release
exec ctest --preset release "$@"
