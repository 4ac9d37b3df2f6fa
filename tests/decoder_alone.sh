#!/usr/bin/env bash
# Builds the decoder alone and proves that no compile or link line names the encoder's dependencies.
set -euo pipefail
cd "$(dirname "$0")/.."

build=${1:-build-decoder}
cmake -S . -B "$build" -G Ninja -DREEB_BUILD_ENCODER=OFF -DCMAKE_EXPORT_COMPILE_COMMANDS=ON >/dev/null
cmake --build "$build"
found=$(grep -iEo 'openmesh|spectra|eigen3?|draco|codec/enc|segmentation|retrieval' "$build/compile_commands.json" "$build/build.ninja" | sort -u || true)
if [[ -n $found ]]; then
  echo "the decoder's build names what it must not: $found" >&2
  exit 1
fi
echo "the decoder builds alone"
