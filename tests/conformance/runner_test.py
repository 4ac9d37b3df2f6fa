#!/usr/bin/env python3
"""Tests of conformance/run.py: what it must not let pass. usage: runner_test.py DECODE_STREAM"""
import pathlib
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree as xml

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
DECODER = sys.argv.pop()

# Decodes, then spoils the output: argument 1 is what to do, then the stream and the output.
SPOILER = """
import subprocess, sys
how, stream, out = sys.argv[1:]
code = subprocess.run([%r, stream, out], stderr=subprocess.DEVNULL).returncode
data = bytearray(open(out, "rb").read())
if how == "position": data[-1] ^= 1
if how == "face": data[4 * (4 + 1)] ^= 1
if how == "cut": data = data[:-4]
if how == "none": data = b""
if how == "code": code = 3 - code
open(out, "wb").write(data)
sys.exit(code)
""" % DECODER


class RunnerTest(unittest.TestCase):
    def run_spoiled(self, how, stream="one_triangle"):
        with tempfile.TemporaryDirectory() as folder:
            script = pathlib.Path(folder) / "spoiler.py"
            script.write_text(SPOILER)
            report = pathlib.Path(folder) / "report.xml"
            run = subprocess.run([sys.executable, ROOT / "conformance/run.py", "--only", stream, "--junit", report,
                                  "--decoder", "%s %s %s {stream} {out}" % (sys.executable, script, how)],
                                 stdout=subprocess.PIPE, text=True)
            return run.returncode, run.stdout, xml.parse(report).getroot()

    def test_right_output_passes(self):
        code, table, report = self.run_spoiled("nothing")
        self.assertEqual(code, 0, table)
        self.assertEqual(report.get("failures"), "0")

    def test_right_refusal_passes(self):
        self.assertEqual(self.run_spoiled("nothing", "next_version")[0], 0)

    def test_wrong_output_fails(self):
        for how, word in (("position", "positions"), ("face", "connectivity"), ("cut", "ends inside"),
                          ("none", "frames"), ("code", "exit code")):
            with self.subTest(how):
                code, table, report = self.run_spoiled(how)
                self.assertEqual(code, 1)
                self.assertIn(word, table)
                self.assertEqual(report.get("failures"), "1")

    def test_missing_decoder_fails(self):
        run = subprocess.run([sys.executable, ROOT / "conformance/run.py", "--only", "one_triangle", "--decoder",
                              "no_such_decoder {stream} {out}"], stdout=subprocess.PIPE)
        self.assertEqual(run.returncode, 1)


if __name__ == "__main__":
    unittest.main()
