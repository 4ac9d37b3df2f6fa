#!/usr/bin/env bash
# The main job from nothing: makes an animated creature, encodes, decodes, compares and draws it into ./demo.
set -euo pipefail
cd "$(dirname "$0")/.."

.ci/setup demo
cmake -S . -B build-demo -G Ninja -DREEB_BUILD_TESTS=OFF -DREEB_BUILD_BINDINGS=OFF >/dev/null
cmake --build build-demo --target reeb
reeb=build-demo/tools/reeb

rm -rf demo
"$reeb" sample creature -o demo/frames/frame_%04d.obj
"$reeb" encode 'demo/frames/*.obj' -o demo/creature.reeb
"$reeb" info demo/creature.reeb
"$reeb" decode demo/creature.reeb -o demo/decoded/frame_%04d.obj
"$reeb" compare demo/frames demo/decoded --tolerance 0.05
"$reeb" picture demo/frames demo/creature.reeb -o demo/creature.png

# With a texture's coordinates, normals and materials
"$reeb" sample creature --attributes --length 8 -o demo/dressed/frame_%04d.obj
"$reeb" encode 'demo/dressed/*.obj' -o demo/dressed.reeb
"$reeb" picture demo/dressed.reeb --attribute usemtl -o demo/materials.png
du -sh demo/frames demo/creature.reeb
echo "look at demo/creature.png and demo/materials.png"
