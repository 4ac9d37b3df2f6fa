#!/usr/bin/env bash
# Installs what is missing, builds everything and runs all tests. Usage: tests/run.sh [BUILD_FOLDER [CMAKE_OPTION...]]
set -euo pipefail
cd "$(dirname "$0")/.."

.ci/setup
build=${1:-build}
shift || true
cmake -S . -B "$build" -G Ninja "$@" >/dev/null
cmake --build "$build"
ctest --test-dir "$build" -j "$(nproc)" --output-on-failure
