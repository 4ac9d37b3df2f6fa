#!/usr/bin/env python3
"""Tells how well the core streams pin the decoding process: changes it one constant, comparison or operator at a time, and
shows which changes no stream tells.

    pip install libclang==14.0.6
    conformance/mutate.py --out build/mutation --sample 500

All mutants are in one program (mutation/mutants.h, mutation/sites.py), which is built once; each is then tried by itself on the
streams that reach it, until one decodes otherwise (mutation/runner.cpp). A mutant that crashes, does not end or takes too much
memory is caught. OUT/results.tsv has what came of each, and a run goes on where the last one with the same sources
stopped. Not part of CI: a whole run takes an hour or two.

With --witness, survivors are tried on further streams (folders or files): those that one of them tells change what some
stream decodes to; the others do not, or we know of no stream. The figure of tests/README.md is caught / (caught + told by
a witness that decodes as a whole).
"""
import argparse
import collections
import concurrent.futures
import hashlib
import os
import pathlib
import pickle
import random
import re
import subprocess
import sys
import threading

from mutation import sites
from coverage import INTERFACE, OTHER_FILES

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent
FOLDERS = ("entropy", "bitstream", "codec/common", "codec/dec")
LEFT_OUT = re.compile(r"kernels_avx|/container_writer|/trace\.cpp|encoder")
# The arithmetic written out, not that of a vector unit: what the specification says.
FLAGS = ["-std=c++20", "-ffp-contract=off", "-fno-fast-math", "-U__SSE2__"]
BASE_ALONE = ["-U__LP64__"]  # of the file that chooses an instruction set


def sources():
    """{path: text} of all that is mutated."""
    files = [p for folder in FOLDERS for p in sorted((ROOT / folder).rglob("*")) if p.suffix in (".h", ".cpp")]
    names = [str(p.relative_to(ROOT)) for p in files]
    left = set(INTERFACE) | set(OTHER_FILES)
    return {n: (ROOT / n).read_bytes() for n in names if n not in left and not LEFT_OUT.search(n)}


def units():
    files = [p for folder in FOLDERS for p in sorted((ROOT / folder).rglob("*.cpp"))]
    return [str(p.relative_to(ROOT)) for p in files if "kernels_avx" not in p.name]


class Mutant(collections.namedtuple("Mutant", "number file line column what site")):
    @property
    def key(self):
        return "%s:%d:%d\t%s" % self[1:5]


class Tree:
    """The mutated sources, and the program made of them."""

    def __init__(self, out, compiler, jobs):
        self.out, self.compiler, self.jobs = out, compiler, jobs
        self.lock = threading.Lock()
        self.texts = sources()
        self.dropped = set()  # (file, start, end): what the compiler does not take
        self.found = self.find()
        self.numbers = self.number()

    def find(self):
        """{file: Finder}; kept for the next run, since it takes minutes."""
        kept, stamp = self.out / "sites.pickle", text_digest(self.texts)
        if kept.exists():
            found = pickle.loads(kept.read_bytes())
            if found[0] == stamp:
                return found[1]
        found = self.find_anew()
        kept.write_bytes(pickle.dumps((stamp, found)))
        return found

    def find_anew(self):
        wanted = {str(ROOT / name): text for name, text in self.texts.items()}
        arguments = FLAGS + ["-I" + str(ROOT), "-xc++", "-resource-dir", resource_folder()]
        parts = [[ROOT / unit for unit in units()[i::self.jobs]] for i in range(self.jobs)]
        found = {}
        with concurrent.futures.ProcessPoolExecutor(self.jobs) as pool:
            for part in pool.map(sites.find, parts, [arguments] * self.jobs, [wanted] * self.jobs):
                for path, finder in part.items():
                    found.setdefault(path, finder).join(finder)
        return {str(pathlib.Path(path).relative_to(ROOT)): f for path, f in found.items()}

    def number(self):
        """{(file, start, end): number}; a constant has two."""
        numbers, named, following = {}, {}, 0
        for name in sorted(self.found):
            for place, site in sorted(self.found[name].sites.items()):
                key = site.key if site.key[0] == "named" else (name, *place)
                if key not in named:
                    named[key] = following
                    following += 2 if "constant" in site.edits[0][3] else 1
                numbers[(name, *place)] = named[key]
        return numbers

    def mutants(self):
        out, seen = [], set()
        for (name, start, end), number in self.numbers.items():
            if (name, start, end) in self.dropped or number in seen:
                continue
            seen.add(number)
            site = self.found[name].sites[(start, end)]
            at = next((e[0] for e in site.edits if e[1] == (1, 0)), start)  # of the operator
            before = self.texts[name][:at]
            place = before.count(b"\n") + 1, at - before.rfind(b"\n")
            variants = ("%s up", "%s down") if "constant" in site.edits[0][3] else ("%s",)
            out += [Mutant(number + i, name, *place, v % site.what, number) for i, v in enumerate(variants)]
        return out

    def write(self, name):
        finder = self.found.get(name)
        text = self.texts[name]
        if finder:
            edits = list(dict.fromkeys(finder.tables))  # of each unit that includes the file
            for (start, end), site in finder.sites.items():
                if (name, start, end) not in self.dropped:
                    number = self.numbers[(name, start, end)]
                    edits += [(a, o, gone, put.replace("{}", str(number))) for a, o, gone, put in site.edits]
            text = sites.rewrite(text, edits)
        path = self.out / "tree" / name
        path.parent.mkdir(parents=True, exist_ok=True)
        if not path.exists() or path.read_bytes() != text:
            path.write_bytes(text)

    def build(self):
        """The program; that of the last run where it is made of the same."""
        kept, stamp = self.out / "built.pickle", text_digest(self.texts, "mutants.h", "runner.cpp")
        if kept.exists():
            built, dropped = pickle.loads(kept.read_bytes())
            if built == stamp:
                self.dropped = dropped
                return self.out / "runner"
        program = self.build_anew()
        kept.write_bytes(pickle.dumps((stamp, self.dropped)))
        return program

    def build_anew(self):
        for name in self.texts:
            self.write(name)
        with concurrent.futures.ThreadPoolExecutor(self.jobs) as pool:
            objects = list(pool.map(self.compile, units()))
        objects.append(self.compile_runner())
        program = self.out / "runner"
        # The kernels of other instruction sets are missing, and `BASE_ALONE` sees to it that nothing calls them.
        subprocess.run([self.compiler, "-o", program, *objects, "-pthread", "-no-pie",
                        "-Wl,--unresolved-symbols=ignore-all"], check=True)
        return program

    def command(self, source, target):
        return [self.compiler, *FLAGS, "-O1", "-w", "-Wno-narrowing", "-fpermissive", "-fmax-errors=200",
                "-fno-diagnostics-show-caret", "-include", HERE / "mutation/mutants.h", "-I", self.out / "tree", "-I", ROOT,
                "-c", source, "-o", target, *(BASE_ALONE if source.name == "instruction_set.cpp" else ())]

    def compile_runner(self):
        target = self.out / "runner.o"
        subprocess.run(self.command(HERE / "mutation/runner.cpp", target), check=True)
        return target

    def compile(self, unit):
        """An object; leaves out the sites that it does not compile with."""
        source = self.out / "tree" / unit if unit in self.texts else ROOT / unit
        target = self.out / "objects" / (unit.replace("/", "-") + ".o")
        target.parent.mkdir(exist_ok=True)
        for _ in range(12):
            run = subprocess.run(self.command(source, target), stderr=subprocess.PIPE, text=True)
            if run.returncode == 0:
                return target
            if not self.drop(run.stderr):
                break
        sys.exit("%s does not compile:\n%s" % (unit, run.stderr[:4000]))

    def drop(self, errors):
        """Takes out the sites at the lines of errors; whether there were any."""
        tree = re.escape(str(self.out / "tree")) + "/"
        places = set(re.findall(r"^%s([^:]+):(\d+):\d+: (?:fatal )?error" % tree, errors, re.M))
        places |= set(re.findall(r"mutants\.h: In [^\n]*\n%s([^:]+):(\d+):\d+:   required from" % tree, errors))
        with self.lock:
            for name, line in places:
                self.drop_line(name, int(line))
                self.write(name)
        return len(places) > 0

    def drop_line(self, name, line):
        text = self.texts[name]
        starts = [0] + [m.end() for m in re.finditer(b"\n", text)]
        first, last = starts[line - 1], starts[line] if line < len(starts) else len(text)
        inside = [p for p in self.found[name].sites if p[0] < last and p[1] > first and (name, *p) not in self.dropped]
        self.dropped |= {(name, *p) for p in inside}
        if not inside:
            self.found[name].tables = [t for t in self.found[name].tables if not first <= t[0] < last]


def text_digest(texts, *more):
    h = hashlib.sha256()
    for name in ("sites.py", *more):
        h.update((HERE / "mutation" / name).read_bytes())
    for name in sorted(texts):
        h.update(name.encode() + b"\0" + texts[name])
    return h.hexdigest()[:12]


def resource_folder():
    return subprocess.run(["clang-14", "-print-resource-dir"], stdout=subprocess.PIPE, text=True, check=True).stdout.strip()


class Stream(collections.namedtuple("Stream", "name hash microseconds whole sites")):
    def line(self):
        return "%s %s %s\n" % (self.name, self.hash, self.microseconds)


def run_streams(program, names):
    """Streams as the unchanged program decodes them."""
    out = []
    for i in range(0, len(names), 200):
        run = subprocess.run([program, "baseline", *names[i:i + 200]], stdout=subprocess.PIPE, text=True, check=True)
        for line in run.stdout.splitlines():
            name, value, time, whole, reached = line.split("\t")
            out.append(Stream(name, value, int(time), whole == "1", frozenset(map(int, reached.split()))))
    return sorted(out, key=lambda s: s.microseconds)


def try_mutant(program, out, mutant, streams):
    """(the stream that tells the mutant, how); nothing if none does."""
    reached = [s for s in streams if mutant.site in s.sites]
    if not reached:
        return None
    listing = out / "lists" / str(mutant.number)
    listing.write_text("".join(s.line() for s in reached))
    environment = {**os.environ, "REEB_MUTANT": str(mutant.number)}
    try:
        run = subprocess.run([program, "try", str(mutant.number), listing], stdout=subprocess.PIPE, text=True,
                             stderr=subprocess.DEVNULL, env=environment, timeout=600)
        code, text = run.returncode, run.stdout
    except subprocess.TimeoutExpired as late:
        code, text = -1, (late.stdout or b"").decode()
    if code == 0:
        return None
    last = text.split()[-1] if text.split() else reached[0].name
    return last, "differs" if code == 1 else "ends by signal %d" % -code


class Results:
    """What came of each mutant, kept in a file."""

    def __init__(self, path, stamp):
        self.path, self.rows = path, {}
        lines = path.read_text().splitlines() if path.exists() else []
        if lines[:1] == [stamp]:
            for line in lines[1:]:
                place, what, result, detail = line.split("\t")
                self.rows[place + "\t" + what] = result, detail
        else:
            path.write_text(stamp + "\n")

    def put(self, key, result, detail):
        self.rows[key] = (result, detail)
        with self.path.open("a") as out:
            out.write("%s\t%s\t%s\n" % (key, result, detail))


def stream_files(places):
    paths = [pathlib.Path(p) for p in places]
    return [str(f) for p in paths for f in (sorted(p.rglob("*.reeb")) if p.is_dir() else [p])]


def judge(program, out, mutant, core, witnesses):
    told = try_mutant(program, out, mutant, core)
    if told:
        return "caught", "%s %s" % (pathlib.Path(told[0]).stem, told[1])
    for whole in (True, False):
        told = try_mutant(program, out, mutant, [w for w in witnesses if w.whole == whole])
        if told:
            return "told" if whole else "told by a fault", "%s %s" % (told[0], told[1])
    return ("survived" if any(mutant.site in s.sites for s in core) else "not run"), "-"


def main():
    parser = argparse.ArgumentParser(description="Mutates the decoder and runs the core streams.")
    parser.add_argument("--out", type=pathlib.Path, default=ROOT / "build/mutation", help="folder for the build and the results")
    parser.add_argument("--compiler", default="g++")
    parser.add_argument("--jobs", "-j", type=int, default=2, help="compilers, and mutants, at a time")
    parser.add_argument("--streams", nargs="+", default=[HERE / "streams/core"], help="folders or files")
    parser.add_argument("--witness", nargs="*", default=[], help="folders or files of further streams")
    parser.add_argument("--again", action="store_true", help="try those that survived again: there are new streams")
    parser.add_argument("--only", default="", help="mutants whose place or text match this expression")
    parser.add_argument("--sample", type=int, help="as many mutants, chosen at random")
    parser.add_argument("--seed", type=int, default=1, help="of the sample: another one is another sample")
    arguments = parser.parse_args()
    out = arguments.out.resolve()
    out.mkdir(parents=True, exist_ok=True)
    tree = Tree(out, arguments.compiler, arguments.jobs)
    program = tree.build()
    run(tree, program, out, arguments)


def run(tree, program, out, arguments):
    core = run_streams(program, stream_files(arguments.streams))
    witnesses = run_streams(program, stream_files(arguments.witness))
    mutants = [m for m in tree.mutants() if re.search(arguments.only, "%s:%d:%d %s" % m[1:5])]
    random.Random(arguments.seed).shuffle(mutants)
    mutants = mutants[:arguments.sample]
    results = Results(out / "results.tsv", "sources %s" % text_digest(tree.texts))
    print("%d mutants, %d sites do not compile; %d streams, %.2f s" %
          (len(mutants), len(tree.dropped), len(core), sum(s.microseconds for s in core) / 1e6))
    (out / "lists").mkdir(exist_ok=True)
    left = [m for m in mutants if m.key not in results.rows or
            arguments.again and results.rows[m.key][0] != "caught"]
    with concurrent.futures.ThreadPoolExecutor(arguments.jobs) as pool:
        for mutant, judged in zip(left, pool.map(lambda m: judge(program, out, m, core, witnesses), left)):
            results.put(mutant.key, *judged)
    report(mutants, results)


def report(mutants, results):
    counts = collections.Counter(results.rows[m.key][0] for m in mutants)
    for mutant in sorted(mutants, key=lambda m: m[1:]):
        result, detail = results.rows[mutant.key]
        if result.startswith(("survived", "told")):
            print("%s:%d:%d  %s  %s  %s" % (*mutant[1:5], result, detail))
    print(dict(counts))
    caught, told = counts["caught"], counts["told"]
    print("caught: %.1f %% of those that change a stream we know of" % (100 * caught / max(1, caught + told)))


if __name__ == "__main__":
    main()
