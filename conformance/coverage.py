#!/usr/bin/env python3
"""Sums up the line coverage of the decoder in a build folder: coverage.py BUILD_FOLDER. See coverage.sh.

The decoding process - from bytes to positions - and the interface that players see are told apart: the interface is for
seeking, playing ahead, pushed bytes, limits and the like, which no stream can reach and tests/bindings and tests/codec do.
Functions that only writers, the encoder or measurements call are left out, though they share files with the decoder.
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
INTERFACE = {
    "bitstream/byte_source.h": "files behind a callback",
    "bitstream/container_reader.cpp": "chunks read again when they are needed",
    "codec/common/base/stop.h": "cancelling",
    "codec/dec/decode_options.h": "what a caller may choose",
    "codec/dec/decode_sequence.cpp": "a whole sequence into memory",
    "codec/dec/decoder.cpp": "frames by number and time, pushed bytes, playing ahead, figures",
    "codec/dec/decoder.h": "the same",
    "codec/dec/group_memory.cpp": "memory that decoding will take",
    "codec/dec/group_store.cpp": "groups kept, dropped and decoded ahead",
    "codec/dec/group_store.h": "the same",
    "codec/dec/guard.h": "exceptions into results",
    "bitstream/memory_account.h": "memory in use",
    "codec/dec/normals.cpp": "normals are computed, not coded",
    "codec/dec/pushed_source.cpp": "pushed bytes",
    "codec/dec/pushed_source.h": "the same",
    "codec/dec/stream_info.cpp": "what a stream holds, told to callers",
    "codec/dec/stream_info.h": "the same",
}
OTHER_FILES = ("bitstream/trace.cpp", "bitstream/container_writer.cpp", "codec/common/base/sequence.h", "codec/common/mesh/faces.cpp",
               "codec/common/base/coding_tools.h")
OTHERS = re.compile(
    r"reeb::(append_|write_|SyntaxWriter::|BinaryEncoder::|RansEncoder::|RawBitWriter::|rans_frequencies|Status::(io|invalid)\b|"
    r"MagnitudeModel::representable|ComponentSum::basis|WeightEstimator::WeightEstimator\(reeb::WeightEstimator const|"
    r"(varuint|f64)_size\b|\w+_kernel::\(anonymous namespace\)::(guess|note)_lanes)|Syntax<reeb::SyntaxWriter>|"
    r"\(anonymous namespace\)::(append_(group|u32)|count_frames|shortest|quoted|plain_order|rans_symbol)|"
    r"BinaryEncoder")


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


def tell(title, counts):
    total = sum(len(lines) for lines in counts.values())
    run = sum(1 for lines in counts.values() for count in lines.values() if count)
    for path, lines in sorted(counts.items()):
        missed = [n for n, count in lines.items() if count == 0]
        if missed:
            print("%-36s %3d of %3d lines missed: %s" % (path, len(missed), len(lines), ranges(missed)))
    print("%s: %d of %d lines run, %.1f %%" % (title, run, total, 100 * run / total))


def main():
    counts = count_lines(pathlib.Path(sys.argv[1]))
    tell("interface", {path: lines for path, lines in counts.items() if path in INTERFACE})
    tell("decoding process", {path: lines for path, lines in counts.items() if path not in INTERFACE})


if __name__ == "__main__":
    main()
