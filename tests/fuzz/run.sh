#!/usr/bin/env bash
# Builds the fuzzers with Clang under AddressSanitizer and UndefinedBehaviorSanitizer and runs each for a while on seeds
# made from the golden streams. Usage: tests/fuzz/run.sh [BUILD_FOLDER [SECONDS]]
set -euo pipefail
cd "$(dirname "$0")/../.."

build=${1:-build-fuzz}
seconds=${2:-60}
fuzzers=(container_fuzz decode_fuzz group_fuzz reference_fuzz)
cmake -S . -B "$build" -G Ninja -DCMAKE_CXX_COMPILER=clang++ -DCMAKE_BUILD_TYPE=RelWithDebInfo \
  -DREEB_BUILD_FUZZERS=ON -DREEB_SANITIZE=address,undefined >/dev/null
cmake --build "$build" --target "${fuzzers[@]}" fuzz_seeds
"$build/tests/fuzz/fuzz_seeds" "$build/seeds" tests/codec/data/*.reeb
for fuzzer in "${fuzzers[@]}"; do
  mkdir -p "$build/found/$fuzzer"
  "$build/tests/fuzz/$fuzzer" -max_len=16384 -rss_limit_mb=1500 -timeout=20 -max_total_time="$seconds" -verbosity=0 \
    -artifact_prefix="$build/found/" "$build/found/$fuzzer" "$build/seeds/${fuzzer%_fuzz}"
  echo "$fuzzer: nothing found in $seconds s"
done
