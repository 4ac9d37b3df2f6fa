#!/usr/bin/env bash
# Decodes streams on several threads under ThreadSanitizer, with the decoder built alone, and plays them for ten seconds
# as hosts do that cancel, are slow and close while the next group is decoded. With `all`, the tests that use several
# threads run under it, too, which takes as long to build as everything does.
# Usage: tests/threads.sh [all [BUILD_FOLDER]]
set -euo pipefail
cd "$(dirname "$0")/.."

what=${1:-decoder}
build=${2:-build-threads}
export TSAN_OPTIONS=halt_on_error=1
configure() {
  cmake -S . -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=RelWithDebInfo \
    -DCMAKE_CXX_FLAGS_RELWITHDEBINFO="-O1 -g1 -DNDEBUG" -DREEB_SANITIZE=thread "$@" >/dev/null
}

if [[ $what == all ]]; then
  configure -DREEB_BUILD_ENCODER=ON
  cmake --build "$build" --target codec_test bindings_test decode_together soak
  "$build/tests/codec/codec_test" "[player]"
  "$build/tests/bindings/bindings_test" "[c],[cpp]"
else
  configure -DREEB_BUILD_ENCODER=OFF
  cmake --build "$build" --target decode_together soak
fi
"$build/conformance/decode_together" tests/codec/data/*.reeb conformance/streams/core/*.reeb
"$build/conformance/soak" 10 tests/codec/data/*.reeb
