#!/usr/bin/env bash
# Lines of the decoder that the conformance streams run: the core streams alone, then all of them. Names what they miss.
# usage: conformance/coverage.sh [BUILD_FOLDER]
set -euo pipefail
cd "$(dirname "$0")/.."
build=${1:-build-coverage}

cmake -S . -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Debug -DREEB_BUILD_ENCODER=OFF \
  -DCMAKE_CXX_FLAGS="--coverage -O0 -fno-inline" >/dev/null
cmake --build "$build" --target decode_stream >/dev/null

measure() {
  find "$build" -name '*.gcda' -delete
  for threads in 1 2; do
    conformance/run.py --decoder "$build/conformance/decode_stream {stream} {out} $threads" --failures --class "$@"
  done
  conformance/coverage.py "$build"
}

echo "== core"
measure core
echo "== all"
measure core uncommon faulty
