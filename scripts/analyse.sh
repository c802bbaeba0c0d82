#!/usr/bin/env bash
# cppcheck (seconds) and clang-tidy (JOBS at a time, default 2) over every file of ours; any finding
# fails. File names limit clang-tidy to them: scripts/analyse.sh transport/bsdf.cpp
# What is left alone, and why: scripts/cppcheck.supp, .clang-tidy, and NOLINT comments in place.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

echo "cppcheck"
cppcheck --quiet --std=c++20 --language=c++ --library=googletest \
  --enable=warning,style,performance,portability --suppressions-list=scripts/cppcheck.supp \
  --error-exitcode=1 -I . core formats images scene spatial transport tools tests bench

# For compile_commands.json; Clang cannot read the headers that GCC has parsed.
cmake --preset release -B build/analyse -DBNVPL_TESTS=ON -DBNVPL_BENCH=ON \
  -DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON >/dev/null
files=("$@")
((${#files[@]})) || mapfile -t files < <(git ls-files '*.cpp')
echo "clang-tidy: ${#files[@]} files"
# The flags are GCC's, some of which Clang does not know.
printf '%s\0' "${files[@]}" | xargs -0 -n 1 -P "${JOBS:-2}" \
  clang-tidy --quiet -p build/analyse --extra-arg=-Wno-unknown-warning-option 2>/dev/null
echo "clean"
