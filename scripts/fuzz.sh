#!/usr/bin/env bash
# Feeds hostile input to every reader of foreign files: runs each fuzz target over its corpus, then for
# SECONDS on inputs that the fuzzer makes (default 20; 0 runs the corpora only), two targets at a time.
#   scripts/fuzz.sh              # every target for 20 s
#   scripts/fuzz.sh 1200 obj     # one target for 20 minutes
# Any finding fails. New inputs are kept in build/fuzz/learned for the next run. The corpora in
# fuzz/corpus are only read.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

seconds=${1:-20}
targets=("${@:2}")
if ((${#targets[@]} == 0)); then
  for corpus in fuzz/corpus/*/; do targets+=("$(basename "$corpus")"); done
fi

for name in "${targets[@]}"; do
  if [[ ! -d fuzz/corpus/$name ]]; then
    echo "fuzz.sh: no target is named $name; use $(basename -a fuzz/corpus/*/ | paste -sd' ')" >&2
    exit 2
  fi
done

scripts/install_packages.sh --build clang libclang-rt-14-dev llvm
echo "Building the fuzz targets into build/fuzz"
cmake --preset fuzz >/dev/null
cmake --build --preset fuzz

out=build/fuzz
mkdir -p "$out"/{learned,findings,logs}
memory=/tmp
if [[ -w /dev/shm ]]; then memory=/dev/shm; fi
inputs=$(mktemp -d "$memory/bnvpl-fuzz.XXXXXX")
trap 'rm -rf "$inputs"' EXIT
export TMPDIR=$inputs UBSAN_OPTIONS=print_stacktrace=1

# Small inputs find the most per time. The memory limits suit them: a file of 4 KiB that makes a reader
# allocate half a GiB at once is a finding.
options=(-max_len=4096 -timeout=60 -malloc_limit_mb=512 -rss_limit_mb=2048 -print_final_stats=1
         -verbosity=1)

fuzz_one() {
  local name=$1 log=$out/logs/$1.log limit=(-max_total_time="$seconds")
  if ((seconds == 0)); then limit=(-runs=0); fi
  mkdir -p "$out/learned/$name"
  local failed=0
  "$out/bin/fuzz_$name" "${options[@]}" "${limit[@]}" -artifact_prefix="$out/findings/$name-" \
    "$out/learned/$name" "fuzz/corpus/$name" >"$log" 2>&1 || failed=1
  local executed edges finding
  executed=$(sed -n 's/^stat::number_of_executed_units: *//p' "$log")
  edges=$(sed -n 's/.* cov: \([0-9]*\) .*/\1/p' "$log" | tail -1)
  printf '%-11s %9s executions, %5s edges covered, ' "$name" "${executed:-?}" "${edges:-0}"
  if ((failed == 0)); then
    echo "no finding"
    return
  fi
  finding=$(sed -n 's/.*Test unit written to //p' "$log" | tail -1)
  echo "FINDING: $(grep -m1 -E 'PROMISE|ERROR:|runtime error|terminate called|DEADLYSIGNAL' "$log")"
  echo "            report: $log"
  if [[ -n $finding ]]; then echo "            again:  $out/bin/fuzz_$name $finding"; fi
  return 1
}

echo "Fuzzing ${#targets[@]} targets, their corpora and $seconds s each, two at a time"
failures=0 running=0
for name in "${targets[@]}"; do
  if ((running == 2)); then
    wait -n || failures=$((failures + 1))
    running=$((running - 1))
  fi
  fuzz_one "$name" &
  running=$((running + 1))
done
for ((; running > 0; --running)); do wait -n || failures=$((failures + 1)); done
if ((failures > 0)); then
  echo "$failures of ${#targets[@]} targets have a finding" >&2
  exit 1
fi
