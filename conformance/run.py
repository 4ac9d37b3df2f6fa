#!/usr/bin/env python3
"""Runs a decoder over the conformance streams and compares what it gives with what it must give.

    conformance/run.py --decoder "build/conformance/decode_stream {stream} {out}"

Exits with 0 when every stream passes, else with 1. conformance/README.md tells what a decoder command must do.
"""
import argparse
import concurrent.futures
import json
import os
import pathlib
import shlex
import subprocess
import sys
import tempfile
import time
import xml.etree.ElementTree as xml

import frames

STREAMS = pathlib.Path(__file__).resolve().parent / "streams"
CLASSES = ("core", "uncommon", "faulty")


class Result:
    def __init__(self, test, fault, seconds):
        self.test, self.fault, self.seconds = test, fault, seconds


class Test:
    """A stream and what it must give."""

    def __init__(self, folder, name, expected):
        self.kind = folder.name
        self.name = name
        self.stream = folder / (name + ".reeb")
        self.expected = expected

    def run(self, command, timeout):
        start = time.monotonic()
        with tempfile.TemporaryDirectory() as folder:
            out = pathlib.Path(folder) / "out"
            words = [w.format(stream=self.stream, out=out) for w in shlex.split(command)]
            try:
                done = subprocess.run(words, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, timeout=timeout)
                fault = self.judge(done, out)
            except subprocess.TimeoutExpired:
                fault = "no end after %d s" % timeout
            except OSError as error:
                fault = str(error)
        return Result(self, fault, time.monotonic() - start)

    def judge(self, done, out):
        """What is wrong, or nothing."""
        wanted = frames.EXIT_CODES[self.expected["status"]]
        if done.returncode != wanted:
            last = done.stderr.decode("utf-8", "replace").strip().splitlines()[-1:]
            return "exit code %d, not %d (%s): %s" % (done.returncode, wanted, self.expected["status"], "".join(last))
        try:
            given = frames.summary(out.read_bytes() if out.exists() else b"")
        except ValueError as fault:
            return str(fault)
        return frames.difference(given, self.expected["frames"])


def load_tests(kinds, only, quick):
    tests = []
    for kind in kinds:
        folder = STREAMS / kind
        for name, expected in json.loads((folder / "test.json").read_text()).items():
            if (not only or name in only) and (expected["quick"] or not quick):
                tests.append(Test(folder, name, expected))
    return tests


def write_junit(path, results):
    suite = xml.Element("testsuite", name="conformance", tests=str(len(results)),
                        failures=str(sum(1 for r in results if r.fault)), time="%.3f" % sum(r.seconds for r in results))
    for r in results:
        case = xml.SubElement(suite, "testcase", classname=r.test.kind, name=r.test.name, time="%.3f" % r.seconds)
        if r.fault:
            xml.SubElement(case, "failure", message=r.fault)
    xml.ElementTree(suite).write(path, encoding="utf-8", xml_declaration=True)


def print_table(results, verbose):
    width = max(len(r.test.name) for r in results)
    for r in results:
        if verbose or r.fault:
            print("%-8s  %-*s  %7.2f s  %s" % (r.test.kind, width, r.test.name, r.seconds, r.fault or "ok"))
    for kind in CLASSES:
        own = [r for r in results if r.test.kind == kind]
        if own:
            passed = sum(1 for r in own if not r.fault)
            print("%-8s  %d of %d pass, %.1f s" % (kind, passed, len(own), sum(r.seconds for r in own)))


def main():
    parser = argparse.ArgumentParser(description="Runs a decoder over the conformance streams.")
    parser.add_argument("--decoder", required=True, metavar="COMMAND", help='e.g. "decode_stream {stream} {out}"')
    parser.add_argument("--class", dest="kinds", nargs="+", choices=CLASSES, default=CLASSES, help="classes of streams")
    parser.add_argument("--only", nargs="+", metavar="NAME", help="these streams alone")
    parser.add_argument("--quick", action="store_true", help="leave out what takes a slow decoder long")
    parser.add_argument("--jobs", "-j", type=int, default=os.cpu_count(), help="decoders at a time")
    parser.add_argument("--timeout", type=float, default=3600, metavar="SECONDS", help="for one stream")
    parser.add_argument("--junit", metavar="FILE", help="writes the results as JUnit XML")
    parser.add_argument("--failures", action="store_true", help="print only what fails, and the sums")
    arguments = parser.parse_args()
    tests = load_tests(arguments.kinds, arguments.only, arguments.quick)
    if not tests:
        parser.error("no such stream")
    with concurrent.futures.ThreadPoolExecutor(arguments.jobs) as pool:
        results = list(pool.map(lambda t: t.run(arguments.decoder, arguments.timeout), tests))
    print_table(results, not arguments.failures)
    if arguments.junit:
        write_junit(arguments.junit, results)
    return 1 if any(r.fault for r in results) else 0


if __name__ == "__main__":
    sys.exit(main())
