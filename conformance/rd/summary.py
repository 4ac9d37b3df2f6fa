#!/usr/bin/env python3
"""Prints what tables of rate_distortion.py come to, as Markdown: the tables that the documents of the project show.

    conformance/rd/summary.py conformance/results.csv
    conformance/rd/summary.py conformance/results_ablations.csv
"""
import statistics
import sys

import figures
import table

TIMED = "kg=0.05"


def markdown(header, lines):
    return "\n".join("| " + " | ".join(cells) + " |" for cells in [header, ["---"] * len(header), *lines]) + "\n"


def rates(results):
    """Reeb's default at each error, and its times."""
    default = figures.BY_NAME["reeb"]
    targets = [default.target_of(setting) for setting in default.targets]
    lines = []
    for s in results.sequences:
        rows = [results.at(s, "reeb", target) for target in targets]
        timed = results.at(s, "reeb", TIMED)
        if any(rows):
            times = f"{timed['encode_s']:.1f} s, {timed['decode_s']:.2f} s" if timed else ""
            lines.append([s, *(f"{row['bpvf']:.3f}" if row else "" for row in rows), times])
    return markdown(["sequence", *default.targets, f"encode, decode at {TIMED.partition('=')[2]}"], lines)


def bd_rates(results):
    """How many times Reeb's rate the others take, on average over the errors that both reach."""
    found = results.bd_rates()
    lines = [[s, *(f"{1 + by_sequence[s] / 100:.2f}" if by_sequence[s] is not None else "–"
                   for by_sequence in found.values())] for s in results.sequences]
    return markdown(["times Reeb's rate", *(figures.BY_NAME[name].words for name in found)], lines)


def ablations(results):
    """Bytes that leaving a tool out adds, mean over the sequences."""
    lines = []
    for name, by_target in results.ablations().items():
        means = [f"{statistics.mean(p for _, p in pairs):+.1f}" if pairs else "–" for pairs in by_target.values()]
        lines.append([figures.BY_NAME[name].words, *means])
    return markdown(["% of the file", *(f"KG {t}" for t in figures.configurations.ABLATION_TARGETS)], lines)


def efforts(results):
    """Bytes and encoding time against the default."""
    return markdown(["", "bytes", "time"], [[c.words, f"{100 * (rate - 1):+.2f} %", f"{time:.2f}"]
                                            for c, rate, time in results.efforts()])


def lossless(results):
    names = results.group("lossless")
    lines = []
    for s in results.sequences:
        rows = [results.at(s, c.name, "lossless") for c in names]
        if any(rows):
            lines.append([s, *(f"{row['bpvf']:.2f}" if row else "–" for row in rows)])
    return markdown(["bits per vertex and frame", *(c.words for c in names)], lines)


def main(words=None):
    paths = sys.argv[1:] if words is None else words
    if not paths or paths[0].startswith("-"):
        print(__doc__)
        return 0 if paths else 2
    rows = {}
    for path in paths:
        rows.update(table.read(path))
    results = figures.Results(rows)
    groups = {c.group for c in results.configurations}
    parts = [rates(results)]
    if "peer" in groups:
        parts.append(bd_rates(results))
    for group, part in (("ablation", ablations), ("effort", efforts), ("lossless", lossless)):
        if group in groups:
            parts.append(part(results))
    print("\n".join(parts), end="")
    return 0


if __name__ == "__main__":
    sys.exit(main())
