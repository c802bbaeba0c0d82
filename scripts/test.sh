#!/usr/bin/env bash
# Installs missing packages, builds everything and runs all tests.
# The steps that fail soonest come first. A table at the end lists the steps and their times.
# With options, ctest is the only step after the build, and gets them: scripts/test.sh -R pipeline
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

summary=()
finish() {
  local code=$?
  printf '\n%-40s %8s  %s\n' step seconds result
  printf '%s\n' "${summary[@]}"
  exit "$code"
}
trap finish EXIT

step() { # name command...
  local name=$1 start=$SECONDS
  shift
  printf '\n== %s\n' "$name"
  local result=passed
  "$@" || result=FAILED
  summary+=("$(printf '%-40s %8d  %s' "$name" $((SECONDS - start)) "$result")")
  [[ $result == passed ]]
}

build() {
  cmake --preset ci -DBNVPL_TESTS=ON -DBNVPL_BENCH=ON && cmake --build --preset ci
}

step "install packages" scripts/install_packages.sh
step "build into build/release" build
if (($# > 0)); then
  step "tests: $*" ctest --preset release "$@"
  exit
fi
step "tests of the parts" ctest --preset release -LE 'pipeline|faults|eval|cluster'
step "the tools, through files and faults" ctest --preset release -L 'pipeline|faults'
step "the pipeline on Slurm, if it is here" ctest --preset release -L cluster
step "evaluation at its quick size" ctest --preset release -L eval
