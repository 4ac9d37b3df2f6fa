#!/usr/bin/env bash
# Tells the bytes of the stripped decoder library; fails past its budget. Usage: tests/decoder_size.sh BUILD_FOLDER
set -euo pipefail

library=$(readlink -f "$1/bindings/libreeb.so")
budget=1000000
stripped=$(mktemp)
trap 'rm -f "$stripped"' EXIT
strip -o "$stripped" "$library"
bytes=$(stat -c %s "$stripped")
echo "decoder library, stripped: $bytes bytes of $budget"
[[ $bytes -le $budget ]]
