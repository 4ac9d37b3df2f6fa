#!/usr/bin/env python3
"""Measures rate and distortion: encodes sequences in named configurations, decodes, compares, and writes a table.

    rate_distortion.py                                    three generated sequences, Reeb and the other codecs
    rate_distortion.py SEQUENCES --csv results.csv -j 2   a folder of sequences (a mesh and a point cache, or frames, in
                                                          a folder each)
    rate_distortion.py --list                             the configurations

Lines that the table already has, made by the same programs from the same input, are not measured again, so that a run
that was interrupted goes on where it stopped. Draw the table with report.py.
"""
import argparse
import concurrent.futures
import dataclasses
import hashlib
import json
import os
import shutil
import sys
import tempfile
import threading
import time

import configurations
import process
import sequences
import table

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))


class Programs:
    """The executables of a build; version tells builds apart."""

    def __init__(self, build):
        peers = os.path.join(build, "conformance", "rd", "peers")
        self.paths = {"reeb": os.path.join(build, "tools", "reeb"),
                      "decode_positions": os.path.join(build, "conformance", "rd", "decode_positions"),
                      "measure_error": os.path.join(build, "conformance", "rd", "measure_error")}
        if os.path.isdir(peers):
            self.paths.update({name: os.path.join(peers, name) for name in os.listdir(peers) if name.endswith("_peer")})
        self._hashes, self._help_text = {}, None

    def lacking(self, configuration):
        """The program that a configuration needs and the build lacks, or the option; empty if there is none."""
        name = configuration.peer + "_peer" if configuration.peer else "reeb"
        if configuration.peer or not os.path.exists(self.paths[name]):
            return "" if os.path.exists(self.paths.get(name, "")) else name
        options = [o for o in ("--" + configuration.unit, *configuration.options) if o.startswith("--")]
        return next((option for option in options if option not in self._help()), "")

    def version(self, configuration):
        names = [configuration.peer + "_peer"] if configuration.peer else ["reeb", "decode_positions"]
        return "".join(self._hash(name) for name in names)

    def _help(self):
        if self._help_text is None:
            self._help_text = process.run([self.paths["reeb"], "encode", "--help"]).output
        return self._help_text

    def _hash(self, name):
        if name not in self._hashes:
            with open(self.paths[name], "rb") as file:
                self._hashes[name] = hashlib.sha256(file.read()).hexdigest()
        return self._hashes[name]


def build_ablations(build):
    """Builds, beside `build`, Reeb that can do without a coding tool; the folder."""
    folder = os.path.abspath(build) + "-ablations"
    print(f"building {folder}", file=sys.stderr)
    process.run(["cmake", "-S", ROOT, "-B", folder, "-G", "Ninja", "-DREEB_BUILD_TESTS=OFF", "-DREEB_ABLATIONS=ON"])
    process.run(["cmake", "--build", folder, "--target", "reeb", "decode_positions", "measure_error"])
    return folder


@dataclasses.dataclass(frozen=True)
class Job:
    sequence: sequences.Sequence
    configuration: configurations.Configuration
    setting: str
    programs: Programs
    version: str

    @property
    def key(self):
        return self.sequence.name, self.configuration.name, self.configuration.target_of(self.setting)


def portable(command):
    """A command as one line without folders, and without the options that only this script needs."""
    words = [os.path.basename(word) if os.sep in word else word for word in command]
    return " ".join(word for word in words if word not in ("--json", "-q"))


def measure(job):
    """Encodes, decodes and compares; the line of the table. Raises process.CommandFailed."""
    programs = job.programs.paths
    with tempfile.TemporaryDirectory(prefix="reeb-rd-") as scratch:
        stream = os.path.join(scratch, job.sequence.name + (".bin" if job.configuration.peer else ".reeb"))
        decoded = os.path.join(scratch, "decoded.raw")
        command = job.configuration.encode_command(programs, job.setting, job.sequence.inputs, stream)
        without = {"REEB_WITHOUT": job.configuration.without} if job.configuration.without else {}
        encoding = process.run(command, **without)
        decoding = process.run(job.configuration.decode_command(programs, stream, decoded), **without)
        if os.path.exists(stream + ".order"):
            shutil.move(stream + ".order", decoded + ".order")
        measured = json.loads(process.run([programs["measure_error"], decoded, *job.sequence.inputs]).output)
        size = os.path.getsize(stream)
    if not job.configuration.peer:
        check_report(job.configuration, json.loads(encoding.output), measured)
    name, configuration, target = job.key
    return {"sequence": name, "configuration": configuration, "target": target, "bytes": size,
            "bpvf": 8 * size / (measured["vertices"] * measured["frames"]),
            **{column: measured[column] for column in ("vertices", "frames", "kg", "rmse", "max_error", "sted")},
            "encode_s": encoding.seconds, "decode_s": decoding.seconds, "encode_mb": encoding.megabytes,
            "decode_mb": decoding.megabytes, "version": job.version,
            "command": " ".join([*(f"{name}={value}" for name, value in without.items()), portable(command)])}


def check_report(configuration, reported, measured):
    """What the encoder said must be what was decoded. Without the vertex order only the encoder can tell the error."""
    if not configuration.keeps_order:
        measured.update({column: reported[column] for column in ("kg", "rmse", "max_error")}, sted=float("nan"))
    elif abs(reported["kg"] - measured["kg"]) > 1e-6 * measured["kg"] + 1e-12:
        raise process.CommandFailed(f"the encoder reports KG {reported['kg']}, decoded it is {measured['kg']}")


def jobs_of(arguments, found):
    """Every line to measure, in the order of the table."""
    base, ablations = Programs(arguments.build), None
    chosen = []
    for configuration in configurations.select(arguments.configurations):
        programs = base
        if configuration.without:
            programs = ablations = ablations or Programs(build_ablations(arguments.build))
        lacking = programs.lacking(configuration)
        if lacking:
            print(f"skipped {configuration.name}: there is no {lacking}", file=sys.stderr)
        else:
            chosen.append((configuration, programs))
    jobs = []
    for sequence in found:
        print_of_input = sequence.fingerprint()
        for configuration, programs in chosen:
            version = hashlib.sha256((programs.version(configuration) + print_of_input).encode()).hexdigest()[:12]
            settings = configuration.targets
            if arguments.kg and configuration.unit == "kg":
                settings = arguments.kg
            jobs += [Job(sequence, configuration, setting, programs, version) for setting in settings]
    return jobs


class Progress:
    """Lines on standard error as jobs end."""

    def __init__(self, total):
        self.total, self.done, self.start = total, 0, time.monotonic()

    def tell(self, job, words):
        self.done += 1
        left = (time.monotonic() - self.start) * (self.total - self.done) / self.done
        name, configuration, target = job.key
        print(f"[{self.done}/{self.total}, {left / 60:.0f} min left] {name:12} {configuration:24} {target:14} {words}",
              file=sys.stderr, flush=True)


def run_all(jobs, rows, path, parallel):
    """Measures what `rows` lacks, keeping `path` up to date; the number of failures."""
    missing = [job for job in jobs if rows.get(job.key, {}).get("version") != job.version]
    print(f"{len(jobs)} lines, {len(jobs) - len(missing)} of them known", file=sys.stderr)
    progress, lock, failures = Progress(len(missing)), threading.Lock(), 0
    with concurrent.futures.ThreadPoolExecutor(parallel) as pool:
        running = {pool.submit(measure, job): job for job in missing}
        for future in concurrent.futures.as_completed(running):
            job = running[future]
            try:
                row = future.result()
            except process.CommandFailed as failure:
                failures += 1
                progress.tell(job, f"FAILED: {failure}")
                continue
            with lock:
                rows[job.key] = row
                if path:
                    table.write(path, in_order(rows))
            progress.tell(job, "{bpvf:8.4f} bpvf  KG {kg:.4f} %  {encode_s:6.2f} s  {decode_s:5.2f} s".format(**row))
    return failures


def in_order(rows):
    """Sequences by name, configurations as listed, targets from coarse to fine."""
    names = [c.name for c in configurations.ALL]

    def place(row):
        known = row["configuration"] in names
        return (row["sequence"], names.index(row["configuration"]) if known else len(names), row["configuration"],
                row["bytes"])

    return sorted(rows.values(), key=place)


def arguments_of(words):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folders", nargs="*", metavar="FOLDER", help="of sequences; generated samples without any")
    parser.add_argument("--samples", nargs="+", metavar="NAME:FRAMES", help="sequences to generate, e.g. sheet:50")
    parser.add_argument("--configurations", nargs="+", default=["profile", "peer"], metavar="NAME",
                        help="names or groups: profile, effort, ablation, bounded, lossless, peer, all; default "
                             "profile peer")
    parser.add_argument("--sequences", nargs="+", metavar="NAME", help="only these")
    parser.add_argument("--kg", nargs="+", metavar="P", help="KG errors in percent in place of each one's own")
    parser.add_argument("--build", default=os.path.join(ROOT, "build"), help="build folder; default build")
    parser.add_argument("--csv", help="the table, which is completed; default rate_distortion.csv")
    parser.add_argument("-j", type=int, default=1, help="so many encodings at once; default 1")
    parser.add_argument("--list", action="store_true", help="list the configurations and stop")
    return parser.parse_args(words)


def main(words=None):
    arguments = arguments_of(words)
    if arguments.list:
        for c in configurations.ALL:
            print(f"{c.name:22} {c.group:9} {c.words}; {c.unit} {' '.join(c.targets)}")
        return 0
    path = arguments.csv or "rate_distortion.csv"
    with tempfile.TemporaryDirectory(prefix="reeb-samples-") as folder:
        found = sequences.find(arguments.folders)
        if arguments.samples or not found:
            found += sequences.samples(Programs(arguments.build).paths["reeb"], arguments.samples or sequences.SAMPLES,
                                       folder)
        found = [s for s in found if not arguments.sequences or s.name in arguments.sequences]
        failures = run_all(jobs_of(arguments, found), table.read(path), path, arguments.j)
    return 1 if failures else 0


if __name__ == "__main__":
    try:
        sys.exit(main())
    except KeyboardInterrupt:
        sys.exit(130)
