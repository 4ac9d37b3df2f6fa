#!/usr/bin/env bash
# Builds the player as static files in BUILD_FOLDER/page, with samples where the reeb command REEB is there to make them.
# Usage: bindings/web/player/build.sh [BUILD_FOLDER [REEB]]; needs the package that bindings/web/build.sh puts there, and npm.
set -euo pipefail
cd "$(dirname "$0")/../../.."

build=$(realpath -m "${1:-build-web}")
reeb=$(realpath -m "${2:-build/tools/reeb}")
cd bindings/web/player
mkdir -p "$build/player/public"
cp package.json package-lock.json "$build"
[[ -d $build/node_modules/vite ]] || npm install --prefix "$build" --ignore-scripts --no-audit --no-fund
cp -r index.html vite.config.js src "$build/player"

sample() {
  local made
  made=$(mktemp -d)
  "$reeb" sample "$1" -q -o "$made/frame_%04d.obj"
  "$reeb" encode "$made/*.obj" -q -f -o "$build/player/public/$1.reeb"
  rm -r "$made"
}
list=()
if [[ -x $reeb ]]; then
  for name in creature sheet mechanism; do
    [[ -f $build/player/public/$name.reeb ]] || sample "$name"
    list+=("{\"name\": \"$name\", \"file\": \"$name.reeb\"}")
  done
fi
(IFS=,; echo "[${list[*]}]") >"$build/player/public/samples.json"

cd "$build/player"
"$build/node_modules/.bin/vite" build --logLevel warn --emptyOutDir --outDir "$build/page"
