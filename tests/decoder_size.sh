#!/usr/bin/env bash
# Tells the bytes of the stripped decoder library, and of the same with the part of Draco that it calls linked in; fails
# past the budget for either. Usage: tests/decoder_size.sh BUILD_FOLDER [CXX [LIBDRACO_ARCHIVE]]
set -euo pipefail
source=$(cd "$(dirname "$0")/.." && pwd)

build=$1
compiler=${2:-c++}
draco=${3:-$("$compiler" -print-file-name=libdraco.a)}
budget_alone=1000000
budget_with_draco=1600000
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

tell() {
  local what=$1 library=$2 budget=$3 bytes
  strip "$library"
  bytes=$(stat -c %s "$library")
  echo "decoder library, stripped, $what: $bytes bytes of $budget"
  [[ $bytes -le $budget ]]
}

cp "$(readlink -f "$build/bindings/libreeb.so")" "$work/alone.so"
tell "without Draco" "$work/alone.so" $budget_alone
[[ -f $draco ]] || { echo "no archive of Draco to link in"; exit 0; }
"$compiler" -shared -o "$work/with_draco.so" -Wl,--whole-archive "$build/bindings/libreeb.a" -Wl,--no-whole-archive \
  "$draco" -Wl,--version-script="$source/bindings/c/reeb.map" -Wl,--gc-sections
tell "with Draco's share" "$work/with_draco.so" $budget_with_draco
