#!/usr/bin/env bash
# What takes too long for every landing: streams played by hosts at their worst, under ThreadSanitizer and under
# AddressSanitizer, and all fuzzers together.
# Usage: tests/soak.sh [SECONDS [FUZZ_SECONDS]]  (60 and 600 unless told)
set -euo pipefail
cd "$(dirname "$0")/.."

seconds=${1:-60}
fuzz_seconds=${2:-600}
for sanitizer in thread address,undefined; do
  build=build-soak-${sanitizer%%,*}
  cmake -S . -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=RelWithDebInfo -DCMAKE_CXX_FLAGS_RELWITHDEBINFO="-O1 -g1 -DNDEBUG" \
    -DREEB_SANITIZE="$sanitizer" -DREEB_BUILD_ENCODER=OFF >/dev/null
  cmake --build "$build" --target soak
  TSAN_OPTIONS=halt_on_error=1 "$build/conformance/soak" "$seconds" tests/codec/data/*.reeb
done
tests/fuzz/run.sh "$fuzz_seconds"
