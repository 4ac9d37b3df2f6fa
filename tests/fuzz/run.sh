#!/usr/bin/env bash
# Builds the fuzzers with Clang under AddressSanitizer and UndefinedBehaviorSanitizer and runs each for a while, from the
# inputs in tests/fuzz/corpus and from the golden streams. Usage: tests/fuzz/run.sh [SECONDS [BUILD_FOLDER]]
# With REEB_KEEP_CORPUS=1 what was learned goes, made small, to tests/fuzz/corpus.
set -euo pipefail
cd "$(dirname "$0")/../.."

seconds=${1:-60}
build=${2:-build-fuzz}
fuzzers=(container decode group push reference)
cmake -S . -B "$build" -G Ninja -DCMAKE_C_COMPILER=clang -DCMAKE_CXX_COMPILER=clang++ \
  -DCMAKE_BUILD_TYPE=RelWithDebInfo -DCMAKE_CXX_FLAGS_RELWITHDEBINFO="-O1 -g1 -DNDEBUG" -DREEB_BUILD_FUZZERS=ON -DREEB_SANITIZE=address,undefined >/dev/null
cmake --build "$build" --target "${fuzzers[@]/%/_fuzz}" fuzz_seeds
rm -rf "$build/seeds"
"$build/tests/fuzz/fuzz_seeds" "$build/seeds" tests/codec/data/*.reeb
for name in "${fuzzers[@]}"; do
  fuzzer=$build/tests/fuzz/${name}_fuzz
  corpus=tests/fuzz/corpus/$name
  mkdir -p "$build/found/$name" "$corpus"
  log=$build/found/$name.log
  status=0
  "$fuzzer" -max_len=16384 -rss_limit_mb=1500 -timeout=20 -max_total_time="$seconds" -verbosity=0 -print_final_stats=1 \
    -artifact_prefix="$build/found/" "$build/found/$name" "$corpus" "$build/seeds/$name" >"$log" 2>&1 || status=$?
  grep -E 'ERROR|SUMMARY|artifact|number_of_executed|#[0-9]+ 0x' "$log" || true
  [[ $status -eq 0 ]] || { echo "$name: see the input in $build/found" >&2; exit 1; }
  echo "$name: nothing found in $seconds s"
  if [[ -n ${REEB_KEEP_CORPUS:-} ]]; then
    rm -rf "$build/kept" && mkdir "$build/kept"
    "$fuzzer" -merge=1 -max_len=2048 "$build/kept" "$corpus" "$build/found/$name" 2>/dev/null
    rm -rf "$corpus" && mkdir "$corpus"
    # The shortest inputs, up to 64 KB of them: seeds to learn from, not a record.
    total=0
    for input in $(ls -Sr "$build/kept"); do
      total=$((total + $(stat -c %s "$build/kept/$input")))
      [[ $total -le 65536 ]] || break
      cp "$build/kept/$input" "$corpus/"
    done
  fi
done
