#!/usr/bin/env bash
# Builds the npm package in BUILD_FOLDER/package; `.ci/setup web` installs what that takes on Debian 12.
# Usage: bindings/web/build.sh [BUILD_FOLDER]
set -euo pipefail
cd "$(dirname "$0")/../.."

build=${1:-build-web}
package=$build/package
cmake -S bindings/web -B "$build" -G Ninja >/dev/null
cmake --build "$build"
mkdir -p "$package"
cp bindings/web/package.json bindings/web/README.md bindings/web/lib/*.d.ts LICENSE "$package"
# What the comments of the modules say is in the types and the sources, too.
for module in bindings/web/lib/*.js; do
  sed -E '/^ *\/\*\*.*\*\/$/d; /^ *\/\*\*/,/\*\/$/d; /^ *\/\//d' "$module" >"$package/${module##*/}"
done
wasm-opt -O3 --converge --enable-simd --enable-bulk-memory --enable-sign-ext --enable-mutable-globals \
  --enable-nontrapping-float-to-int "$build/reeb.wasm" -o "$package/reeb.wasm"
