#!/usr/bin/env bash
# Builds the wheel, installs it into a clean virtual environment and tests it there.
# Usage: bindings/python/test.sh [BUILD_FOLDER]
# With a build of Reeb its libraries are linked; without one, everything is built, as `pip install bindings/python` does.
# PYTHON names the interpreter, python3 by default; WHEEL a wheel to test in place of building one.
set -euo pipefail
cd "$(dirname "$0")/../.."

python=${PYTHON:-python3}
build=${1:+$(realpath "$1")}
home=$(mktemp -d)
trap 'rm -rf "$home"' EXIT
export PIP_DISABLE_PIP_VERSION_CHECK=1 PIP_NO_WARN_SCRIPT_LOCATION=1

"$python" -m venv "$home/env"
if [[ -z ${WHEEL:-} ]]; then
  "$home/env/bin/pip" wheel -q bindings/python --no-deps -w "$home/wheel" ${build:+-C cmake.define.REEB_BUILD_FOLDER="$build"}
  WHEEL=$(ls "$home"/wheel/*.whl)
fi
"$home/env/bin/pip" install -q "$WHEEL[test]"
# Away from the sources, which must not be what is imported.
cp -r bindings/python/tests "$home/tests"
cd "$home"
REEB_STREAMS="$OLDPWD/conformance/streams" REEB_EXAMPLES="$OLDPWD/examples/python" "$home/env/bin/python" -m pytest -q -p no:cacheprovider tests
cd "$OLDPWD"
"$home/env/bin/python" -m mypy --strict --config-file bindings/python/pyproject.toml --cache-dir "$home/mypy" examples/python/*.py
"$home/env/bin/python" -m mypy --strict --config-file bindings/python/pyproject.toml --cache-dir "$home/mypy" -p reeb
