#!/usr/bin/env python3
"""Encodes sequences at a ladder of errors, decodes and compares them, and prints a table (CSV with --csv).

usage: conformance/measure.py [--reeb build/tools/reeb] [--kg 0.5 0.1] [--options="--reorder"] [--csv FILE] FOLDER

FOLDER holds one folder a sequence: NAME/NAME.obj (first frame) and NAME/NAME.pc2 (all frames).
Where FOLDER is absent the run is skipped with a word.
"""
import argparse
import csv
import json
import os
import resource
import subprocess
import sys
import tempfile

COLUMNS = ["sequence", "options", "target_kg", "bytes", "bpvf", "kg", "rmse", "max_error", "encode_s", "decode_s"]


def timed(command):
    """Runs a command; CPU seconds it took, and its standard output."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    done = subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime, done.stdout


def measure(reeb, folder, name, kg, options):
    source = os.path.join(folder, name, name)
    inputs = [source + ".obj", source + ".pc2"]
    with tempfile.TemporaryDirectory() as scratch:
        stream = os.path.join(scratch, name + ".reeb")
        decoded = os.path.join(scratch, name + ".pc2")
        encode_s, text = timed([reeb, "encode", *inputs, "-o", stream, "--kg", str(kg), "--json", "-q", *options])
        decode_s, _ = timed([reeb, "decode", stream, "-o", decoded, "-q"])
        figures = json.loads(text)
        row = {"sequence": name, "options": " ".join(options), "target_kg": kg, "bytes": os.path.getsize(stream),
               "encode_s": round(encode_s, 2), "decode_s": round(decode_s, 2)}
        row.update({key: figures[key] for key in ("bpvf", "kg", "rmse", "max_error")})
        if "--reorder" not in options:  # vertices are where they were: what was reported must be what is decoded
            _, text = timed([reeb, "compare", source + ".pc2", decoded, "--json", "-q"])
            if abs(json.loads(text)["kg"] / figures["kg"] - 1) > 1e-6:
                raise SystemExit(f"{name}: encode reports KG {figures['kg']}, compare {json.loads(text)['kg']}")
    return row


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder")
    parser.add_argument("--reeb", default="build/tools/reeb")
    parser.add_argument("--kg", type=float, nargs="+", default=[0.5, 0.1])
    parser.add_argument("--only", nargs="+", default=None, metavar="NAME")
    parser.add_argument("--options", default="", help="further options of reeb encode, in one word")
    parser.add_argument("--csv", default=None)
    arguments = parser.parse_args()
    if not os.path.isdir(arguments.folder):
        print(f"skipped: there is no folder {arguments.folder}", file=sys.stderr)
        return 0
    names = sorted(n for n in os.listdir(arguments.folder) if os.path.isdir(os.path.join(arguments.folder, n)))
    rows = []
    for name in arguments.only or names:
        for kg in arguments.kg:
            row = measure(arguments.reeb, arguments.folder, name, kg, arguments.options.split())
            rows.append(row)
            print("{sequence:12} target {target_kg:<5} KG {kg:.4f} %  {bpvf:8.4f} bpvf {bytes:9,} bytes"
                  "  encode {encode_s:6.2f} s  decode {decode_s:5.2f} s".format(**row), flush=True)
    if arguments.csv:
        with open(arguments.csv, "w", newline="") as out:
            writer = csv.DictWriter(out, COLUMNS)
            writer.writeheader()
            writer.writerows(rows)
    return 0


if __name__ == "__main__":
    sys.exit(main())
