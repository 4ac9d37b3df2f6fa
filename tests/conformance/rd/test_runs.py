"""The runner, the table, the check and the drawings, on programs made of a few lines."""
import contextlib
import io
import os
import re
import stat
import sys
import tempfile
import unittest
import xml.etree.ElementTree

CONFORMANCE = os.path.join(os.path.dirname(__file__), "..", "..", "..", "conformance")
sys.path[:0] = [CONFORMANCE, os.path.join(CONFORMANCE, "rd")]

import check_results  # noqa: E402
import configurations  # noqa: E402
import process  # noqa: E402
import report  # noqa: E402
import rate_distortion  # noqa: E402
import sequences  # noqa: E402
import summary  # noqa: E402
import table  # noqa: E402

# Stands for all programs of a build: "encodes" to a file whose size tells the error asked for, and notes that it did.
# A shell script, since it runs often.
FAKE = r"""#!/bin/sh
here=$(dirname "$0")
case "$*" in *--help*) echo "--kg --profile --reorder"; exit;; esac
case $(basename "$0") in
reeb)
  while [ $# -gt 0 ]; do
    case $1 in -o) out=$2;; --kg) kg=$2;; esac
    shift
  done
  case $kg in 1) size=100;; 0.5) size=200;; 0.1) size=1000;; 0.05) size=2000;;
  *) echo "the target is out of reach" >&2; exit 1;; esac
  echo "$kg" >>"$here/calls"
  head -c $((size + ${MORE:-0})) /dev/zero >"$out"
  echo "{\"kg\": $kg, \"rmse\": 1, \"max_error\": 2}";;
decode_positions) cp "$1" "$2";;
*)
  case $(wc -c <"$1") in 100) kg=1;; 200) kg=0.5;; 1000) kg=0.1;; 2000) kg=0.05;; *) kg=7;; esac
  echo "{\"vertices\": 4, \"frames\": 2, \"kg\": $kg, \"rmse\": 1, \"max_error\": 2, \"sted\": 3}";;
esac
"""


class Build:
    """A build folder of fakes, and a folder with one sequence."""

    def __init__(self):
        self.folder = tempfile.TemporaryDirectory()
        self.build = os.path.join(self.folder.name, "build")
        for path in ("tools/reeb", "conformance/rd/decode_positions", "conformance/rd/measure_error"):
            program = os.path.join(self.build, path)
            os.makedirs(os.path.dirname(program), exist_ok=True)
            with open(program, "w", encoding="utf-8") as file:
                file.write(FAKE)
            os.chmod(program, os.stat(program).st_mode | stat.S_IXUSR)
        self.sequences = os.path.join(self.folder.name, "sequences")
        os.makedirs(os.path.join(self.sequences, "walk"))
        for name in ("walk.obj", "walk.pc2"):
            self.write(os.path.join("walk", name), name)
        self.csv = os.path.join(self.folder.name, "t.csv")

    def write(self, name, text):
        with open(os.path.join(self.sequences, name), "w", encoding="utf-8") as file:
            file.write(text)

    def encodings(self):
        """Since the last time that it was asked."""
        path = os.path.join(self.build, "tools", "calls")
        with open(path, encoding="utf-8") as calls:
            count = len(calls.readlines())
        os.remove(path)
        return count

    def run(self, *words, program=rate_distortion.main):
        with contextlib.redirect_stderr(io.StringIO()) as err, contextlib.redirect_stdout(io.StringIO()) as out:
            code = program([self.sequences, "--build", self.build, "--csv", self.csv, *words])
        return code, err.getvalue() + out.getvalue()


class RunTest(unittest.TestCase):
    def setUp(self):
        self.build = Build()
        self.addCleanup(self.build.folder.cleanup)

    def test_writes_a_line_for_each_target(self):
        code, _ = self.build.run("--configurations", "profile", "--kg", "0.5", "0.1", "-j", "2")
        self.assertEqual(code, 0)
        rows = table.read(self.build.csv)
        row = rows["walk", "reeb", "kg=0.5"]
        self.assertEqual((row["bytes"], row["kg"], row["sted"], row["vertices"]), (200, 0.5, 3, 4))
        self.assertEqual(row["bpvf"], 200)  # 8 * 200 / (4 * 2)
        self.assertEqual(row["command"], "reeb encode walk.obj walk.pc2 -o walk.reeb --kg 0.5 --no-report "
                                         "--attribute *=drop --group-length 512 -T 1")
        self.assertIn(("walk", "reeb-fast", "kg=0.1"), rows)
        self.assertNotEqual(rows["walk", "reeb-reorder", "kg=0.5"]["sted"], 3)  # its order is not known
        self.assertGreater(row["encode_s"], 0)

    def test_measures_nothing_twice(self):
        words = ("--configurations", "profile", "--kg", "0.5")
        self.build.run(*words)
        self.build.encodings()
        _, said = self.build.run(*words)
        self.assertIn("4 lines, 4 of them known", said)
        self.build.run("--configurations", "reeb-fast", "--kg", "0.5", "0.1")
        self.assertEqual(self.build.encodings(), 1)

    def test_measures_anew_what_changed(self):
        words = ("--configurations", "reeb-fast", "--kg", "0.5")
        self.build.run(*words)
        self.build.write("walk/walk.pc2", "other frames")
        self.assertIn("1 lines, 0 of them known", self.build.run(*words)[1])
        program = os.path.join(self.build.build, "conformance", "rd", "decode_positions")
        with open(program, "a", encoding="utf-8") as file:
            file.write("# another version\n")
        self.assertIn("1 lines, 0 of them known", self.build.run(*words)[1])
        self.assertEqual(len(table.read(self.build.csv)), 1)

    def test_goes_on_after_a_failure(self):
        code, said = self.build.run("--configurations", "reeb-fast", "--kg", "0.2", "0.5")
        self.assertEqual(code, 1)
        self.assertIn("FAILED: the target is out of reach", said)
        self.assertEqual(list(table.read(self.build.csv)), [("walk", "reeb-fast", "kg=0.5")])

    def test_skips_what_the_build_lacks(self):
        code, said = self.build.run("--configurations", "draco", "reeb-lossless")
        self.assertEqual(code, 0)
        self.assertIn("there is no draco_peer", said)
        self.assertIn("there is no --lossless", said)


class CheckTest(unittest.TestCase):
    def setUp(self):
        self.build = Build()
        self.addCleanup(self.build.folder.cleanup)
        self.build.run("--configurations", "profile", "--kg", "0.5", "0.1")

    def check(self, *words):
        return self.build.run(*words, program=check_results.main)

    def test_equal_lines_pass(self):
        code, said = self.check()
        self.assertEqual(code, 0)
        self.assertIn("8 lines measured again: 0 worse, 0 better", said)

    def test_verdicts(self):
        old = {"bytes": 1000, "kg": 0.5, "rmse": float("nan")}
        for new, expected in (({"bytes": 1009}, 0), ({"bytes": 1011}, -1), ({"bytes": 989}, 1),
                              ({"bytes": 900, "kg": 0.506}, -1), ({"kg": 0.504}, 0), ({"rmse": 7}, 0)):
            self.assertEqual(check_results.verdict(old, {**old, **new}), expected, new)

    def test_a_line_from_nothing_to_something_is_worse(self):
        lossless = {"bytes": 9, "kg": 0, "rmse": 0}
        self.assertEqual(check_results.verdict(lossless, {**lossless, "kg": 1e-9}), -1)

    def test_a_lossy_report_fails(self):
        os.environ["MORE"] = "1"
        self.addCleanup(os.environ.pop, "MORE")
        code, said = self.check()  # the file no longer has the error that the encoder reports
        self.assertEqual(code, 1)
        self.assertIn("the encoder reports", said)

    def test_a_larger_file_fails(self):
        rows = table.read(self.build.csv)
        for row in rows.values():
            row["bytes"] *= 0.98
        table.write(self.build.csv, rows.values())
        code, said = self.check()
        self.assertEqual(code, 3)
        self.assertIn("WORSE", said)
        self.assertIn("kg=0.5", said)
        self.assertEqual(self.check("--update")[0], 3)
        self.assertEqual(self.check()[0], 0)


class ProcessTest(unittest.TestCase):
    def test_tells_time_and_memory(self):
        used = process.run([sys.executable, "-c", "x = bytearray(90_000_000); print(sum(range(3_000_000)))"])
        self.assertEqual(used.output, "4499998500000\n")
        self.assertGreater(used.seconds, 0.01)
        self.assertGreater(used.megabytes, 85)

    def test_passes_the_last_word_of_a_failure_on(self):
        with self.assertRaisesRegex(process.CommandFailed, "^second$"):
            process.run([sys.executable, "-c", "import sys; sys.exit('first\\nsecond')"])


class SequencesTest(unittest.TestCase):
    def test_finds_caches_and_frames(self):
        with tempfile.TemporaryDirectory() as folder:
            for name in ("walk/walk.obj", "walk/walk.mdd", "run/f1.obj", "run/f2.obj", "notes/readme.txt"):
                os.makedirs(os.path.dirname(os.path.join(folder, name)), exist_ok=True)
                open(os.path.join(folder, name), "w", encoding="utf-8").close()
            found = sequences.find([folder])
            self.assertEqual([s.name for s in found], ["run", "walk"])
            self.assertEqual([len(s.inputs) for s in found], [1, 2])
            self.assertEqual(sequences.find([os.path.join(folder, "walk")]), [found[1]])
            with self.assertRaises(SystemExit):
                sequences.find([os.path.join(folder, "notes")])


class ConfigurationsTest(unittest.TestCase):
    def test_names_are_told_apart(self):
        names = [c.name for c in configurations.ALL]
        self.assertEqual(len(names), len(set(names)))
        self.assertFalse(set(names) & {c.group for c in configurations.ALL})

    def test_coding_tools_are_those_of_the_codec(self):
        header = os.path.join(CONFORMANCE, "..", "codec", "common", "base", "coding_tools.h")
        with open(header, encoding="utf-8") as file:
            names = re.findall(r'constexpr char k\w+\[\] = "([a-z-]+)"', file.read())
        self.assertEqual(sorted(names), sorted(configurations.TOOLS))

    def test_selects_by_name_and_group(self):
        self.assertEqual([c.name for c in configurations.select(["zfp", "pca"])], ["pca", "zfp"])
        self.assertEqual(len(configurations.select(["effort"])), 9)
        self.assertEqual(configurations.select(["all"]), list(configurations.ALL))
        with self.assertRaises(SystemExit):
            configurations.select(["nothing"])


class SummaryTest(unittest.TestCase):
    def row(self, configuration, target, size):
        numbers = dict.fromkeys(table.NUMBERS, 1.0)
        return {"sequence": "walk", "configuration": configuration, "target": target, "version": "", "command": "",
                **numbers, "bytes": size, "bpvf": size / 100}

    def test_tables_by_hand(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "t.csv")
            table.write(path, [self.row("reeb", "kg=0.5", 100), self.row("without-rdo", "kg=0.5", 103),
                               self.row("reeb-effort-3", "kg=0.5", 98), self.row("fpzip-lossless", "lossless", 999)])
            with contextlib.redirect_stdout(io.StringIO()) as out:
                self.assertEqual(summary.main([path]), 0)
        for line in ("| walk |  | 1.000 |  |  |  |  |  |",
                     "| without rate-distortion optimised quantization | +3.0 | – | – |",
                     "| Reeb, effort 3 | -2.00 % | 1.00 |", "| walk | 9.99 |"):
            self.assertIn(line, out.getvalue())


class ReportTest(unittest.TestCase):
    def test_page_and_drawing_are_whole(self):
        build = Build()
        self.addCleanup(build.folder.cleanup)
        build.run("--configurations", "profile", "--kg", "1", "0.5", "0.1", "0.05")
        page, drawing = (os.path.join(build.folder.name, name) for name in ("r.html", "r.svg"))
        self.assertEqual(report.main([build.csv, "-o", page, "--svg", drawing]), 0)
        with open(page, encoding="utf-8") as file:
            text = file.read()
        self.assertIn("walk", text)
        self.assertNotIn("src=\"http", text)  # nothing is fetched
        self.assertIn("+0.0 %", text)  # the fakes of all configurations have one size
        points = xml.etree.ElementTree.parse(drawing).getroot().iter("{http://www.w3.org/2000/svg}circle")
        self.assertEqual(len(list(points)), 3 * 4)


if __name__ == "__main__":
    unittest.main()
