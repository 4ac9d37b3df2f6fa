#!/usr/bin/env python3
"""Sums up the line coverage of the decoder in a build folder: coverage.py BUILD_FOLDER. See coverage.sh.

Functions that only writers or other users of the library call are left out, though they share files with the decoder.
"""
import collections
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
UNITS = ("entropy/", "bitstream/", "codec/common/", "codec/dec/")
OTHER_FILES = ("bitstream/trace.cpp", "bitstream/container_writer.cpp", "codec/common/sequence.h", "codec/common/faces.cpp")
OTHERS = re.compile(
    r"reeb::(append_|write_|SyntaxWriter::|BinaryEncoder::|decode_sequence|Status::(io|invalid)\b|"
    r"MagnitudeModel::representable)|Syntax<reeb::SyntaxWriter>|\(anonymous namespace\)::(append_group|count_frames|"
    r"shortest|quoted)")


def gcov(build):
    """The reports of gcov on every object of the build's libraries."""
    notes = [p.resolve() for p in build.rglob("*.gcno") if "CMakeFiles" in p.parts and "CompilerId" not in str(p)]
    with tempfile.TemporaryDirectory() as folder:
        for note in notes:
            run = subprocess.run(["gcov", "--json-format", "--stdout", "--demangled-names", note], cwd=folder,
                                 stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, check=True)
            for line in run.stdout.splitlines():
                yield json.loads(line)


def count_lines(build):
    """{file: {line: times it ran}}."""
    counts = collections.defaultdict(dict)
    for report in gcov(build):
        for file in report["files"]:
            path = os.path.relpath(os.path.join(report["current_working_directory"], file["file"]), ROOT)
            if not path.startswith(UNITS) or path in OTHER_FILES:
                continue
            names = {f["name"]: f["demangled_name"] for f in file["functions"]}
            for line in file["lines"]:
                if OTHERS.search(names.get(line.get("function_name"), "")):
                    continue
                number = line["line_number"]
                counts[path][number] = max(counts[path].get(number, 0), line["count"])
    return counts


def ranges(numbers):
    out = []
    for n in sorted(numbers):
        if out and n == out[-1][1] + 1:
            out[-1][1] = n
        else:
            out.append([n, n])
    return ", ".join(str(a) if a == b else "%d-%d" % (a, b) for a, b in out)


def main():
    counts = count_lines(pathlib.Path(sys.argv[1]))
    total = sum(len(lines) for lines in counts.values())
    run = sum(1 for lines in counts.values() for count in lines.values() if count)
    for path, lines in sorted(counts.items()):
        missed = [n for n, count in lines.items() if count == 0]
        if missed:
            print("%-36s %3d of %3d lines missed: %s" % (path, len(missed), len(lines), ranges(missed)))
    print("%d of %d lines run, %.1f %%" % (run, total, 100 * run / total))


if __name__ == "__main__":
    main()
