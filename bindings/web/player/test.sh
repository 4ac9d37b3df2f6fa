#!/usr/bin/env bash
# Builds the player and tries it in Chromium; on Debian 12. The package is made first where it is not there.
# Usage: bindings/web/player/test.sh [BUILD_FOLDER [REEB]]; pictures go to the folder REEB_PICTURES, if given
set -euo pipefail
cd "$(dirname "$0")/../../.."

.ci/setup web page
build=$(realpath -m "${1:-build-web}")
[[ -f $build/package/reeb.wasm ]] || bindings/web/build.sh "$build"
bindings/web/player/build.sh "$build" "${2:-build/tools/reeb}"

# A square with a texture of four colours.
square=$build/player/square
mkdir -p "$square"
python3 - "$square" <<'PYTHON'
import pathlib
import struct
import sys
import zlib

home = pathlib.Path(sys.argv[1])
chunk = lambda kind, data: struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
rows = b"\0\xff\0\0\0\xff\0" + b"\0\0\0\xff\xff\xff\xff"  # red, green above blue, white
(home / "four.png").write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", 2, 2, 8, 2, 0, 0, 0))
                              + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))
(home / "square.mtl").write_text("newmtl four\nmap_Kd four.png\n")
for t in range(4):
    (home / f"square{t}.obj").write_text(f"mtllib square.mtl\nv 0 0 {t / 9}\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"
                                         "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nusemtl four\nf 1/1 2/2 3/3 4/4\n")
PYTHON
"${2:-build/tools/reeb}" encode "$square/*.obj" --embed -q -f -o "$square/square.reeb"
REEB_PAGE=$build/page node --test bindings/web/player/test.mjs
