#!/usr/bin/env bash
# Writes the API reference as HTML; a warning of doxygen is an error. Usage: docs/reference.sh [OUTPUT_FOLDER]
set -euo pipefail
cd "$(dirname "$0")/.."

export REEB_REFERENCE=${1:-build/reference}
mkdir -p "$REEB_REFERENCE"
doxygen docs/Doxyfile
echo "$REEB_REFERENCE/html/index.html"
