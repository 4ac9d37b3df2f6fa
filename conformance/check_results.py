#!/usr/bin/env python3
"""Measures again what a table of results holds, and reports every line that got worse by more than 1 %.

    conformance/check_results.py              the generated samples of results_samples.csv, within a minute
    conformance/check_results.py SEQUENCES    results.csv, as far as the folder has its sequences

Worse is a larger file, or a larger error. Exit code 3 where a line got worse, 1 where one cannot be measured. With
--update the table takes the new figures, better or worse; such a change is there to be reviewed.
"""
import argparse
import os
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "rd"))

import configurations  # noqa: E402
import rate_distortion  # noqa: E402
import sequences  # noqa: E402
import table  # noqa: E402

TOLERANCE = 0.01
COMPARED = ("bytes", "kg", "rmse")


def changes(old, new):
    """[(column, relative change), ...] of the columns that a line is judged by; more is worse."""
    out = []
    for column in COMPARED:
        if old[column] == old[column] and new[column] != old[column]:  # neither unknown nor equal
            out.append((column, new[column] / old[column] - 1 if old[column] else float("inf")))
    return out


def verdict(old, new):
    """-1 where the line got worse, 1 where it takes over 1 % fewer bytes at no more error, else 0."""
    changed = dict(changes(old, new))
    if any(change > TOLERANCE for change in changed.values()):
        return -1
    return 1 if changed.get("bytes", 0) < -TOLERANCE else 0


def describe(old, new):
    name = "{:14} {:16} {:10}".format(*table.key(old))
    return name + ", ".join(f"{column} {table.brief(old[column])} -> {table.brief(new[column])} ({100 * change:+.2f} %)"
                            for column, change in changes(old, new))


def compare(before, after):
    """Prints lines that changed by much; the number that got worse."""
    judged = [(verdict(before[key], row), before[key], row) for key, row in after.items() if key in before]
    for sign, title in ((1, "better by more than 1 %:"), (-1, "WORSE by more than 1 %:")):
        lines = [describe(old, new) for found, old, new in judged if found == sign]
        if lines:
            print(title, *lines, sep="\n  ")
    worse = sum(found < 0 for found, _, _ in judged)
    print(f"{len(judged)} lines measured again: {worse} worse, {sum(found > 0 for found, _, _ in judged)} better")
    return worse


def jobs_of(before, found, build, names):
    """A job for every line of the table whose sequence was found; `names`: configurations or groups."""
    wanted = {c.name for c in configurations.select(names)}
    by_name = {c.name: c for c in configurations.ALL}
    programs = rate_distortion.Programs(build)
    jobs = []
    for name, configuration, target in before:
        sequence = next((s for s in found if s.name == name), None)
        if sequence and configuration in wanted:
            c = by_name[configuration]
            setting = target.partition("=")[2]
            jobs.append(rate_distortion.Job(sequence, c, setting, programs, version=""))
    return jobs


def arguments_of(words):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folders", nargs="*", metavar="FOLDER", help="of the sequences of results.csv")
    parser.add_argument("--csv", help="another table")
    parser.add_argument("--configurations", nargs="+", metavar="NAME",
                        default=["profile", "effort", "bounded", "lossless"],
                        help="names or groups as in rate_distortion.py; all but ablation, peer")
    parser.add_argument("--build", default=os.path.join(os.path.dirname(HERE), "build"), help="default build")
    parser.add_argument("-j", type=int, default=1, help="so many encodings at once; default 1")
    parser.add_argument("--update", action="store_true", help="write the new figures into the table")
    return parser.parse_args(words)


def main(words=None):
    arguments = arguments_of(words)
    path = arguments.csv or os.path.join(HERE, "results.csv" if arguments.folders else "results_samples.csv")
    before = table.read(path)
    if not before:
        raise SystemExit(f"{path}: has no lines")
    with tempfile.TemporaryDirectory(prefix="reeb-samples-") as folder:
        found = sequences.find(arguments.folders)
        if not arguments.folders:
            reeb = rate_distortion.Programs(arguments.build).paths["reeb"]
            found = sequences.samples(reeb, sequences.SAMPLES, folder)
        after = {}
        jobs = jobs_of(before, found, arguments.build, arguments.configurations)
        failures = rate_distortion.run_all(jobs, after, None, arguments.j)
    worse = compare(before, after)
    if arguments.update:
        table.write(path, rate_distortion.in_order({**before, **after}))
    if failures or not after:
        print("some lines could not be measured" if after else "nothing to measure")
        return 1
    return 3 if worse else 0


if __name__ == "__main__":
    try:
        sys.exit(main())
    except KeyboardInterrupt:
        sys.exit(130)
