#!/usr/bin/env python3
"""Makes the conformance streams anew: streams, what they decode to, and the lists of them.

    cmake --build build --target generate_streams decode_stream
    conformance/generate.py --build build

generate_streams writes what the encoder and the syntax structures make; faulty.py damages some of that. The hashes are
those of the decoder in the build; a stream whose result is not the one announced stops the run. The same build makes
the same bytes.
"""
import argparse
import json
import pathlib
import shutil
import subprocess
import sys
import tempfile

import faulty
import frames
import stream_parts

FOLDER = pathlib.Path(__file__).resolve().parent / "streams"
LARGEST = 60000  # bytes of a stream
QUICK = 3000  # vertices times planes that a slow decoder can do in a second or two

INTRODUCTION = {
    "core": "What the encoder writes, and what pins the decoding process beside that: meshes at its bounds and sections of random "
            "bytes. Every decoder gives these frames.",
    "uncommon": "Extremes that the syntax allows and the encoder does not write. Every decoder gives these frames too.",
    "faulty": "What is damaged or breaks the specification. A decoder gives this result, and these frames alone.",
}


def generate(build, folder):
    """(class, name, status, sentence) of each stream."""
    run = subprocess.run([build / "conformance/generate/generate_streams", folder], stdout=subprocess.PIPE, text=True,
                         check=True)
    return [tuple(line.split("\t")) for line in run.stdout.splitlines()]


def decode(build, stream, status):
    with tempfile.TemporaryDirectory() as folder:
        out = pathlib.Path(folder) / "out"
        done = subprocess.run([build / "conformance/decode_stream", stream, out], stderr=subprocess.PIPE, text=True)
        if done.returncode != frames.EXIT_CODES[status]:
            sys.exit("%s: exit code %d where %s is announced: %s" % (stream.name, done.returncode, status, done.stderr))
        return frames.summary(out.read_bytes())


def list_streams(kind, entries):
    lines = ["# Streams: %s" % kind, "", INTRODUCTION[kind] + " Made by `conformance/generate.py`.", "",
             "| stream | bytes | result | what it is for |", "|---|---|---|---|"]
    for name, entry in sorted(entries.items()):
        size = (FOLDER / kind / (name + ".reeb")).stat().st_size
        lines.append("| %s | %d | %s | %s |" % (name, size, entry["result"], entry["sentence"]))
    return "\n".join(lines) + "\n"


def record(build, kind, name, status, sentence):
    stream = FOLDER / kind / (name + ".reeb")
    data = stream.read_bytes()
    if len(data) > LARGEST:
        sys.exit("%s has %d bytes" % (name, len(data)))
    given = decode(build, stream, status)
    count = given["count"] if isinstance(given, dict) else len(given)
    return {"status": status, "quick": stream_parts.work(data) <= QUICK, "frames": given,
            "sentence": sentence, "result": "%s, %d frame%s" % (status, count, "" if count == 1 else "s")}


def write_class(kind, entries):
    kept = {name: {key: entry[key] for key in ("status", "quick", "frames")} for name, entry in sorted(entries.items())}
    text = json.dumps(kept, indent=0).replace("{\n\"frame\"", "{\"frame\"").replace(",\n\"positions\"", ", \"positions\"")
    text = text.replace(",\n\"connectivity\"", ", \"connectivity\"").replace("\"\n}", "\"}")
    (FOLDER / kind / "test.json").write_text(text + "\n")
    (FOLDER / kind / "README.md").write_text(list_streams(kind, entries))


def main():
    parser = argparse.ArgumentParser(description="Makes the conformance streams anew.")
    parser.add_argument("--build", type=pathlib.Path, default="build", help="build folder")
    build = parser.parse_args().build.resolve()
    shutil.rmtree(FOLDER, ignore_errors=True)
    made = generate(build, FOLDER)
    made += faulty.generate(FOLDER)
    for kind in INTRODUCTION:
        write_class(kind, {name: record(build, k, name, status, sentence)
                           for k, name, status, sentence in made if k == kind})
    print("%d streams, %d bytes" % (len(made), sum(f.stat().st_size for f in FOLDER.glob("*/*.reeb"))))


if __name__ == "__main__":
    main()
