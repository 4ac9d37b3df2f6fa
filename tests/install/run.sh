#!/usr/bin/env bash
# run.sh BUILD_FOLDER SOURCE_FOLDER CMAKE: installs the build, moves the tree, and builds projects outside of it against
# what is there: the examples by find_package, shared and static, one of them by pkg-config, and an encoder.
set -euo pipefail

build=$1
source=$2
cmake=$3
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
stream=$source/tests/codec/data/fast.reeb

for component in decoder decoder_static encoder tools; do
  "$cmake" --install "$build" --prefix "$work/first" --component $component >/dev/null
done
mv "$work/first" "$work/moved"  # nothing may remember where it was
prefix=$work/moved

expect() {  # expect TEXT COMMAND...: the command's output has the text
  local text=$1
  shift
  local out
  out=$("$@" 2>&1) || { echo "failed: $*"; echo "$out"; exit 1; }
  grep -qF "$text" <<<"$out" || { echo "no '$text' from: $*"; echo "$out"; exit 1; }
}

echo "== the installed tree"
library=$(find "$prefix" -name libreeb.so)
expect "libreeb.so.0" readelf -d "$library"
others=$(nm -D --defined-only "$library" | awk '{print $3}' | grep -v '^reeb_' || true)
[[ -z $others ]] || { echo "visible beside reeb_*: $others"; exit 1; }
expect "Compress" "$prefix/bin/reeb" --help
[[ -n $(find "$prefix" -name reeb.1) ]]
for file in bash-completion/completions/reeb zsh/site-functions/_reeb fish/vendor_completions.d/reeb.fish; do
  [[ -s $prefix/share/$file ]]
done
remembered=$(grep -rlF -e "$source" -e "$work/first" "$prefix" --include='*.cmake' --include='*.pc' --include='*.h' || true)
[[ -z $remembered ]] || { echo "names this machine's folders: $remembered"; exit 1; }

echo "== each header compiles alone"
alone() {  # alone STANDARD HEADER INCLUDE_FOLDER, by gcc and, where it is there, by clang
  local compiler
  for compiler in gcc clang; do
    command -v $compiler >/dev/null || continue
    $compiler -x "${1%%[0-9]*}" -std="$1" -Wall -Wextra -Wpedantic -Wconversion -Wno-sign-conversion -Werror \
      -fsyntax-only -I"$3" - <<<"#include <$2>" || { echo "$2 does not compile alone as $1"; exit 1; }
  done
}
for header in reeb.h reeb_attributes.h; do
  alone c99 $header "$prefix/include"
  alone c++11 $header "$prefix/include"
done
alone c++17 reeb.hpp "$prefix/include"
alone c++17 reeb_attributes.hpp "$prefix/include"
while read -r header; do
  alone c++20 "$header" "$prefix/include/reeb"
done < <(cd "$prefix/include/reeb" && find . -name "*.h" -printf "%P\n")

echo "== find_package: examples and an encoder"
for project in "$source/examples" "$source/tests/install/outside"; do
  name=$(basename "$project")
  "$cmake" -S "$project" -B "$work/$name" -DCMAKE_PREFIX_PATH="$prefix" -DCMAKE_BUILD_TYPE=Release \
    >"$work/log" 2>&1 || { cat "$work/log"; exit 1; }
  "$cmake" --build "$work/$name" -j2 >"$work/log" 2>&1 || { cat "$work/log"; exit 1; }
done
expect "36 frames" "$work/examples/player" "$stream" 2
expect "poses" "$work/examples/slow_motion" "$stream"
expect "36 frames" "$work/outside/static_player" "$stream" 2
expect "encoded 3 frames" "$work/outside/encode_something"
if ldd "$work/outside/static_player" | grep -q libreeb; then
  echo "the static example needs the shared library"
  exit 1
fi

echo "== pkg-config"
export PKG_CONFIG_PATH
PKG_CONFIG_PATH=$(dirname "$(find "$prefix" -name reeb.pc)")
read -ra flags <<<"$(pkg-config --cflags --libs reeb)"
cc -std=c99 "$source/examples/player.c" "${flags[@]}" -o "$work/pkg_player"
LD_LIBRARY_PATH=$(dirname "$library") expect "36 frames" "$work/pkg_player" "$stream" 2

echo "== size of the decoder, stripped"
strip -o "$work/stripped.so" "$library"
echo "libreeb.so: $(stat -c %s "$work/stripped.so") bytes"
