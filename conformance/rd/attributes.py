#!/usr/bin/env python3
"""What attributes cost in Reeb and in others: runs attribute_benchmark over the meshes of a folder.

    cmake --build build --target attribute_benchmark
    conformance/rd/attributes.py FOLDER --build build --csv conformance/results_attributes.csv

FOLDER and the folders in it hold OBJ files, of numbered ones the first is taken, and glTF. Lines: mesh, attribute,
codec, setting, bytes that the attribute adds to the file. On standard error: Reeb's bytes over the least of others.
"""
import argparse
import csv
import pathlib
import re
import subprocess
import sys
import tempfile

import gltf_obj

HERE = pathlib.Path(__file__).resolve().parent


def meshes(folder, made):
    """OBJ files with texture coordinates or materials; glTF as OBJ in the folder `made`."""
    for path in sorted(folder.rglob("*.obj")):
        number = re.search(r"(\d+)$", path.stem)
        text = path.read_text(errors="replace")
        if (number is None or int(number[1]) == 1) and re.search(r"^(vt|usemtl) ", text, re.MULTILINE):
            yield path
    for path in sorted(folder.rglob("*.gl*")):
        try:
            text = gltf_obj.to_obj(path)
        except (ValueError, KeyError) as fault:
            print("%s: left out: %s" % (path.name, fault), file=sys.stderr)
            continue
        out = made / (path.stem + ".obj")
        out.write_text(text)
        yield out


def report(rows):
    least = {}
    for row in rows:
        key = (row["mesh"], row["attribute"], row["setting"])
        if row["codec"] != "reeb":
            least[key] = min(least.get(key, float("inf")), float(row["bytes"]))
    for row in rows:
        key = (row["mesh"], row["attribute"], row["setting"])
        if row["codec"] == "reeb" and key in least:
            print("%-24s %-10s %-14s %7s bytes, %.3f of the others' least" % (*key, row["bytes"], float(row["bytes"]) / least[key]),
                  file=sys.stderr)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--build", type=pathlib.Path, default=HERE.parents[1] / "build")
    parser.add_argument("--csv", type=pathlib.Path, help="table to write; standard output unless told")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as made:
        inputs = list(meshes(arguments.folder, pathlib.Path(made)))
        run = subprocess.run([arguments.build / "tests/tools/attribute_benchmark", *inputs], stdout=subprocess.PIPE,
                             text=True, check=True)
    if arguments.csv:
        arguments.csv.write_text(run.stdout)
    else:
        sys.stdout.write(run.stdout)
    report(list(csv.DictReader(run.stdout.splitlines())))


if __name__ == "__main__":
    main()
