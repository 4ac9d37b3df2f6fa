#!/usr/bin/env bash
# Builds the tests that use several threads with ThreadSanitizer and runs them. Usage: tests/threads.sh [BUILD_FOLDER]
set -euo pipefail
cd "$(dirname "$0")/.."

build=${1:-build-threads}
cmake -S . -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=RelWithDebInfo -DCMAKE_CXX_FLAGS_RELWITHDEBINFO="-O1 -g1 -DNDEBUG" -DREEB_SANITIZE=thread >/dev/null
cmake --build "$build" --target codec_test bindings_test
export TSAN_OPTIONS=halt_on_error=1
"$build/tests/codec/codec_test" "[player]"
"$build/tests/bindings/bindings_test" "[c]"
