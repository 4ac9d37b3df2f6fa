#!/usr/bin/env bash
# Decodes a few streams, of every profile and with attributes, under valgrind, which sees uses of memory that nothing
# was written to. Some ten seconds of processor time.
# Usage: tests/valgrind.sh [BUILD_FOLDER], a build of the decoder without sanitizers
set -euo pipefail
cd "$(dirname "$0")/.."

build=${1:-build-decoder}
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
cmake --build "$build" --target decode_stream
for name in full_planes many_corrections fast_fans thesis_noise lossless_full hub attributes_texture motion_unused; do
  valgrind -q --error-exitcode=9 "$build/conformance/decode_stream" "conformance/streams/core/$name.reeb" "$out/$name"
done
echo "valgrind: nothing found"
