#!/usr/bin/env bash
# Builds the npm package, holds it to its size, and runs its tests and the conformance streams under node; on Debian 12.
# Usage: bindings/web/test.sh [BUILD_FOLDER]
set -euo pipefail
cd "$(dirname "$0")/../.."

.ci/setup web
build=$(realpath -m "${1:-build-web}")
budget=150000
bindings/web/build.sh "$build"
package=$build/package
bytes=$(cat "$package"/{reeb.wasm,reeb.js,clip.js,render_mesh.js,attribute_types.js,instance.js,range_source.js} | gzip -9 | wc -c)
echo "the decoder and its JavaScript, gzip: $bytes bytes of $budget"
[[ $bytes -le $budget ]]

cp bindings/web/player/package.json bindings/web/player/package-lock.json "$build"
[[ -d $build/node_modules/three ]] || npm install --prefix "$build" --ignore-scripts --no-audit --no-fund
cp bindings/web/test/types.ts "$build/types.ts"
"$build/node_modules/.bin/tsc" --noEmit --strict --target es2022 --module nodenext --skipLibCheck "$build/types.ts"
REEB_PACKAGE=$package node --test bindings/web/test/*.test.mjs
conformance/run.py --failures --decoder "node bindings/web/test/decode_stream.mjs $package {stream} {out}"
