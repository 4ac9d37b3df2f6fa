#!/usr/bin/env bash
# figures_set.sh REEB FOLDER: a folder of ten individuals for each kind of figure of `reeb sample`.
set -euo pipefail

reeb=$1
folder=$2
# The message about a sample that is not there names all kinds.
kinds=$("$reeb" sample none -o none.pc2 2>&1 | sed 's/.*kinds: //; s/,//g' || true)
for kind in $kinds; do
  for individual in {1..10}; do
    "$reeb" sample "$kind-$individual" --length 1 -q -f -o "$folder/$kind/${kind}_${individual}_%d.off"
  done
done
