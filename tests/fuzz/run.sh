#!/usr/bin/env bash
# Builds the fuzzers with Clang under AddressSanitizer and UndefinedBehaviorSanitizer and runs each for a while, as many
# at a time as there are processors, from the inputs in tests/fuzz/corpus and from streams in the tree.
# Usage: tests/fuzz/run.sh [SECONDS [BUILD_FOLDER]]
# With REEB_KEEP_CORPUS=1 what was learned goes, made small, to tests/fuzz/corpus.
set -euo pipefail
cd "$(dirname "$0")/../.."

export seconds=${1:-60}
export build=${2:-build-fuzz}
fuzzers=(archive connectivity container decode group mesh_file push reference work)

run() {
  local name=$1 status=0
  local fuzzer=$build/tests/fuzz/${name}_fuzz corpus=tests/fuzz/corpus/$name log=$build/found/$name.log
  local longest=16384
  [[ $name != work ]] || longest=1024  # what that allows of time is for every byte
  mkdir -p "$build/found/$name" "$corpus" "$build/seeds/$name"
  "$fuzzer" -max_len=$longest -rss_limit_mb=1500 -timeout=20 -max_total_time="$seconds" -verbosity=0 -print_final_stats=1 \
    -artifact_prefix="$build/found/" "$build/found/$name" "$corpus" "$build/seeds/$name" >"$log" 2>&1 || status=$?
  grep -E 'ERROR|SUMMARY|artifact|#[0-9]+ 0x' "$log" || true
  [[ $status -eq 0 ]] || { echo "$name: see the input in $build/found" >&2; return 1; }
  echo "$name: nothing found in $seconds s, $(grep -oP 'number_of_executed_units: *\K.*' "$log") inputs"
}
export -f run

# The shortest inputs that were found, up to 32 KB of them: seeds to learn from, not a record.
keep() {
  local name=$1 total=0
  local corpus=tests/fuzz/corpus/$name kept=$build/kept/$name
  rm -rf "$kept" && mkdir -p "$kept"
  "$build/tests/fuzz/${name}_fuzz" -merge=1 -max_len=2048 "$kept" "$corpus" "$build/found/$name" 2>/dev/null
  rm -rf "$corpus" && mkdir "$corpus"
  for input in $(ls -Sr "$kept"); do
    total=$((total + $(stat -c %s "$kept/$input")))
    [[ $total -le 32768 ]] || break
    cp "$kept/$input" "$corpus/"
  done
}

cmake -S . -B "$build" -G Ninja -DCMAKE_CXX_COMPILER=clang++ \
  -DCMAKE_BUILD_TYPE=RelWithDebInfo -DCMAKE_CXX_FLAGS_RELWITHDEBINFO="-O1 -g1 -DNDEBUG" -DREEB_BUILD_FUZZERS=ON -DREEB_SANITIZE=address,undefined >/dev/null
cmake --build "$build" --target "${fuzzers[@]/%/_fuzz}" fuzz_seeds
rm -rf "$build/seeds"
# The golden streams have a little of everything, the smallest of the others are soon decoded.
find conformance/streams/core -name '*.reeb' -size -1500c -exec \
  "$build/tests/fuzz/fuzz_seeds" "$build/seeds" tests/codec/data/*.reeb {} +
printf '%s\n' "${fuzzers[@]}" | xargs -P "$(nproc)" -I{} bash -euo pipefail -c 'run {}'
[[ -z ${REEB_KEEP_CORPUS:-} ]] || for name in "${fuzzers[@]}"; do keep "$name"; done
