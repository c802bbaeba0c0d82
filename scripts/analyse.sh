#!/usr/bin/env bash
# Runs cppcheck (seconds) and clang-tidy (JOBS at a time, default 2) over all files of the project.
# Any finding fails. File names limit clang-tidy to them: scripts/analyse.sh transport/bsdf.cpp
# scripts/cppcheck.supp, .clang-tidy and NOLINT comments name the exceptions and their reasons.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

for program in cppcheck clang-tidy; do
  command -v "$program" >/dev/null || {
    echo "analyse.sh: $program is not installed; apt-get install $program" >&2
    exit 2
  }
done
echo "cppcheck"
cppcheck --quiet --std=c++20 --language=c++ --library=googletest \
  --enable=warning,style,performance,portability --suppressions-list=scripts/cppcheck.supp \
  --error-exitcode=1 -I . core formats images scene spatial transport tools tests bench fuzz

# This makes compile_commands.json, of which each file needs an entry of its own, and the headers
# that the build makes. Clang cannot read GCC's precompiled headers.
cmake --preset release -B build/analyse -DBNVPL_TESTS=ON -DBNVPL_BENCH=ON \
  -DCMAKE_UNITY_BUILD=OFF -DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON >/dev/null
cmake --build build/analyse --target bnvpl_build_id >/dev/null
files=("$@")
((${#files[@]})) || mapfile -t files < <(git ls-files '*.cpp')
echo "clang-tidy: ${#files[@]} files"
# Clang does not know some of GCC's warnings.
printf '%s\0' "${files[@]}" | xargs -0 -n 1 -P "${JOBS:-2}" \
  clang-tidy --quiet -p build/analyse --extra-arg=-Wno-unknown-warning-option 2>/dev/null
echo "clean"
