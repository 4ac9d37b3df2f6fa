#!/usr/bin/env bash
# Builds the decoder in other ways - compilers, optimisation, sanitizers, word sizes, processors - and runs the
# conformance streams on each: decoded bits do not depend on any of it.
# usage: conformance/cross.sh [KIND...]   kinds: gcc clang O0 sanitize i386 arm64; all of them where none is named
# Needs, on Debian, what .ci/setup installs, and `conformance/cross.sh setup` for i386 and arm64.
set -euo pipefail
cd "$(dirname "$0")/.."

setup() {
  local as_root=()
  [[ $(id -u) -eq 0 ]] || as_root=(sudo)
  "${as_root[@]}" dpkg --add-architecture arm64
  "${as_root[@]}" dpkg --add-architecture i386
  "${as_root[@]}" apt-get update -qq
  DEBIAN_FRONTEND=noninteractive "${as_root[@]}" apt-get install -y -qq --no-install-recommends \
    libstdc++6:i386 libstdc++6:arm64 g++-i686-linux-gnu g++-aarch64-linux-gnu qemu-user
}

# cross KIND: CMake options that make it.
options() {
  case $1 in
    gcc) echo -DCMAKE_CXX_COMPILER=g++ ;;
    clang) echo -DCMAKE_CXX_COMPILER=clang++ ;;
    O0) echo -DCMAKE_CXX_COMPILER=g++ -DCMAKE_BUILD_TYPE=Debug -DCMAKE_CXX_FLAGS=-O0 ;;
    sanitize) echo -DCMAKE_CXX_COMPILER=clang++ -DCMAKE_BUILD_TYPE=RelWithDebInfo -DREEB_SANITIZE=address,undefined ;;
    i386) foreign i686; echo -DREEB_WERROR=OFF ;;  # sizes of 32 bits warn
    arm64) foreign aarch64 ;;
    *) echo "no such kind: $1" >&2; return 1 ;;
  esac
}

foreign() {
  echo -DCMAKE_SYSTEM_NAME=Linux -DCMAKE_SYSTEM_PROCESSOR="$1" -DCMAKE_CXX_COMPILER="$1-linux-gnu-g++"
}

run_kind() {
  local kind=$1 build=build-cross/$1 runner=
  # shellcheck disable=SC2046  # options are words
  cmake -S . -B "$build" -G Ninja -DREEB_BUILD_ENCODER=OFF \
    $(command -v ccache >/dev/null && echo -DCMAKE_CXX_COMPILER_LAUNCHER=ccache) \
    $(options "$kind") >/dev/null || return 1
  cmake --build "$build" --target decode_stream >/dev/null || return 1
  if [[ $kind == arm64 ]]; then runner=qemu-aarch64; fi
  conformance/run.py --decoder "$runner $build/conformance/decode_stream {stream} {out}" --failures
}

if [[ ${1:-} == setup ]]; then
  setup
  exit
fi
failed=()
for kind in "${@:-gcc clang O0 sanitize i386 arm64}"; do
  for k in $kind; do
    echo "== $k"
    start=$SECONDS
    run_kind "$k" || failed+=("$k")
    echo "   $((SECONDS - start)) s"
  done
done
[[ ${#failed[@]} -eq 0 ]] || { echo "failed: ${failed[*]}"; exit 1; }
