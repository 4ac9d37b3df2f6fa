#!/usr/bin/env python3
"""Checks that includes go the way that the table of folders in README.md says, and that the table has no cycle.

A folder may include its own files, those of the folders named in its cell "may use" and of all that these may use;
libraries only where its own cell names them.
"""
import os
import re
import subprocess
import sys

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
LIBRARIES = {"Eigen": "Eigen", "Spectra": "Spectra", "draco": "Draco", "CLI": "CLI11", "nlohmann": "nlohmann-json",
             "png.h": "libpng", "stb": "stb", "OpenMesh": "OpenMesh", "catch2": "Catch2", "nanobind": "nanobind"}
INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]', re.MULTILINE)


def folders_in(cell):
    return re.findall(r"`([\w/]+)/`", cell)


def read_table(text):
    """{folder: (folders, libraries) that it may use}"""
    table = {}
    for line in text.splitlines():
        cells = [cell.strip() for cell in line.strip().strip("|").split("|")]
        if line.startswith("| `") and len(cells) == 4 and folders_in(cells[0]):
            libraries = {word for word in LIBRARIES.values() if re.search(rf"\b{re.escape(word)}\b", cells[3])}
            table[folders_in(cells[0])[0]] = (folders_in(cells[3]), libraries)
    return table


def reach(table, folder, path=()):
    """All folders below `folder`, itself included; fails on a cycle."""
    if folder in path:
        raise SystemExit("README.md: a cycle of folders: " + " -> ".join([*path, folder]))
    if folder not in table:
        raise SystemExit(f"README.md: the table has no row for {folder}/, which {path[-1]}/ may use")
    return {folder}.union(*(reach(table, other, (*path, folder)) for other in table[folder][0]))


def folder_of(path, table):
    """The row of a file: the longest that is a prefix of its path."""
    parts = path.split("/")[:-1]
    for length in range(len(parts), 0, -1):
        if "/".join(parts[:length]) in table:
            return "/".join(parts[:length])
    return None


def faults_of(path, text, table, below):
    folder = folder_of(path, table)
    if folder is None:
        yield f"{path}: README.md has no row for its folder"
        return
    for quote, name in INCLUDE.findall(text):
        if quote == "<":
            library = LIBRARIES.get(name.split("/")[0])
            if library and library not in table[folder][1]:
                yield f"{path} includes <{name}>, but README.md does not let {folder}/ use {library}"
        elif os.path.exists(os.path.join(ROOT, name)):
            other = folder_of(name, table)
            if other not in below[folder]:
                yield f"{path} includes {name}, but README.md does not let {folder}/ use {other}/"


def main():
    with open(os.path.join(ROOT, "README.md"), encoding="utf-8") as file:
        table = read_table(file.read())
    below = {folder: reach(table, folder) for folder in table}
    listed = subprocess.run(["git", "ls-files", "*.cpp", "*.h", "*.hpp", "*.c"], cwd=ROOT, check=True,
                            capture_output=True, text=True).stdout.split()
    faults = []
    for path in listed:
        with open(os.path.join(ROOT, path), encoding="utf-8") as file:
            faults += faults_of(path, file.read(), table, below)
    print("\n".join(faults) or f"{len(listed)} files include what {len(table)} rows of README.md allow")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
