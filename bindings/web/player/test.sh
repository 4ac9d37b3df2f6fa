#!/usr/bin/env bash
# Builds the player and tries it in Chromium; on Debian 12. The package is made first where it is not there.
# Usage: bindings/web/player/test.sh [BUILD_FOLDER [REEB]]; pictures go to the folder REEB_PICTURES, if given
set -euo pipefail
cd "$(dirname "$0")/../../.."

.ci/setup web page
build=$(realpath -m "${1:-build-web}")
[[ -f $build/package/reeb.wasm ]] || bindings/web/build.sh "$build"
bindings/web/player/build.sh "$build" "${2:-build/tools/reeb}"
REEB_PAGE=$build/page node --test bindings/web/player/test.mjs
