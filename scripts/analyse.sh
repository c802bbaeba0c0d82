#!/usr/bin/env bash
# Runs cppcheck, which takes seconds, and clang-tidy (JOBS files at a time, default 2) over the C++ sources;
# any finding fails. File names limit clang-tidy to them: scripts/analyse.sh transport/bsdf.cpp
# Suppressions and their reasons are in scripts/cppcheck.supp, .clang-tidy, and NOLINT comments.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

echo "cppcheck"
cppcheck --quiet --std=c++20 --language=c++ --library=googletest \
  --enable=warning,style,performance,portability --suppressions-list=scripts/cppcheck.supp \
  --error-exitcode=1 -I . core formats images scene spatial transport tools tests bench

# Makes compile_commands.json. Clang cannot read GCC's precompiled headers.
cmake --preset release -B build/analyse -DBNVPL_TESTS=ON -DBNVPL_BENCH=ON \
  -DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON >/dev/null
files=("$@")
((${#files[@]})) || mapfile -t files < <(git ls-files '*.cpp')
echo "clang-tidy: ${#files[@]} files"
# Clang does not know some of GCC's flags.
printf '%s\0' "${files[@]}" | xargs -0 -n 1 -P "${JOBS:-2}" \
  clang-tidy --quiet -p build/analyse --extra-arg=-Wno-unknown-warning-option 2>/dev/null
echo "clean"
