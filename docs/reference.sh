#!/usr/bin/env bash
# Writes the API reference as HTML; a warning of doxygen is an error. Usage: docs/reference.sh [OUTPUT_FOLDER]
set -euo pipefail
cd "$(dirname "$0")/.."

export REEB_REFERENCE=${1:-build/reference}
mkdir -p "$REEB_REFERENCE"
# What is installed is documented, nothing else: the C and C++ interfaces and the encoder's headers.
encoder_headers=$(sed -n 's/^ *foreach(header \(.*\))$/\1/p' cmake/ReebInstall.cmake)
[[ -n $encoder_headers ]] || { echo "cmake/ReebInstall.cmake lists no headers" >&2; exit 1; }
export REEB_HEADERS="bindings/c/reeb.h bindings/c/reeb_attributes.h bindings/cpp/reeb.hpp bindings/cpp/reeb_attributes.hpp $encoder_headers"
doxygen docs/Doxyfile
echo "$REEB_REFERENCE/html/index.html"
