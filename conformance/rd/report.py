#!/usr/bin/env python3
"""Draws a table that rate_distortion.py made: one HTML page that needs nothing else, and curves as SVG.

    conformance/rd/report.py rate_distortion.csv -o report.html [SEQUENCES]
    conformance/rd/report.py conformance/results.csv --svg curves.svg --only chicken cow dance

Given the folders of the sequences, the page shows what they look like (drawn by `reeb picture`).
"""
import argparse
import base64
import html
import math
import os
import statistics
import sys
import tempfile

import curves
import figures
import process
import sequences
import table

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(HERE))
HEADLINE_KG = 0.1
SPEED_TARGET = "kg=0.05"


def shade(percent):
    """Attributes of a table cell that tell better (less) from worse by colour, stronger with every doubling."""
    kind = "good" if percent < 0 else "bad"
    return f' class="{kind}" style="--much:{min(0.6, 0.13 * abs(math.log2(1 + percent / 100))):.2f}"'


def signed(percent):
    return f"{percent:+.1f} %" if percent < 200 else f"{1 + percent / 100:.1f} ×"


def rows_of(lines, header):
    head = "".join(f"<th>{html.escape(cell)}</th>" for cell in header)
    return f'<div class="scroll"><table><tr>{head}</tr>{"".join(lines)}</table></div>'


def cells(*values):
    return "".join(value if value.startswith("<td") else f"<td>{value}</td>" for value in values)


def headline(results):
    """Cards: how many times Reeb's rate the others take."""
    cards = []
    for c in results.group("peer"):
        ratios = list(results.times_the_rate(c.name, HEADLINE_KG).values())
        if ratios:
            cards.append(f'<div class="card"><b>{statistics.median(ratios):.3g} ×</b><span>the bits of Reeb: '
                         f'{html.escape(c.words)} at a KG error of {HEADLINE_KG} %, median of {len(ratios)} '
                         f'sequences</span></div>')
    return f'<div class="cards">{"".join(cards)}</div>' if cards else ""


def legend(results):
    buttons = []
    for c in results.configurations:
        if c.name in (*figures.DRAWN, "reeb-bounded"):
            line = f'<svg viewBox="0 0 24 8"><path d="M0 4h24" {curves.look(c.name)} stroke-width="3"/></svg>'
            buttons.append(f'<button data-name="{c.name}" aria-pressed="true">{line}{html.escape(c.words)}</button>')
    measures = "".join(f'<button data-measure="{m}" aria-pressed="{str(m == "kg").lower()}">{html.escape(words)}'
                       '</button>' for m, words in figures.MEASURES.items())
    return f'<div class="legend">{"".join(buttons)}<span class="measures">{measures}</span></div>'


def sequence_cards(results, pictures):
    cards = []
    for s in results.sequences:
        row = next(row for row in results.rows.values() if row["sequence"] == s)
        plots = []
        for measure, words in figures.MEASURES.items():
            drawn = results.curves(s, measure)
            if not drawn:
                continue
            body = curves.panel(drawn, 0, -18, 540, 338, "", "bits per vertex and frame", words)
            hidden = "" if measure == "kg" else " hidden"
            plots.append(f'<svg viewBox="0 0 540 324" data-measure="{measure}"{hidden}>{body}</svg>')
        if not plots:
            continue
        picture = f'<img alt="{s}" src="data:image/png;base64,{pictures[s]}">' if s in pictures else ""
        cards.append(f'<div class="sequence"><div class="head"><h3>{html.escape(s)}</h3><small>{row["vertices"]:,.0f} '
                     f'vertices, {row["frames"]:.0f} frames</small></div>{picture}{"".join(plots)}</div>')
    return f'<div class="sequences">{"".join(cards)}</div>'


def bd_table(results, measure):
    rates = results.bd_rates(measure=measure)
    lines = []
    for s in results.sequences:
        values = [by_sequence[s] for by_sequence in rates.values()]
        lines.append("<tr>" + cells(html.escape(s), *("–" if v is None else f"<td{shade(v)}>{signed(v)}</td>"
                                                      for v in values)) + "</tr>")
    return rows_of(lines, ["", *(figures.BY_NAME[name].words for name in rates)]) if rates else ""


def rate_table(results):
    """Bits per vertex and frame of Reeb's configurations at each KG error."""
    parts = []
    for c in results.group("profile"):
        targets = [c.target_of(setting) for setting in c.targets]
        lines = []
        for s in results.sequences:
            rows = [results.at(s, c.name, target) for target in targets]
            if any(rows):
                lines.append("<tr>" + cells(html.escape(s), *(f"{row['bpvf']:.3f}" if row else "–" for row in rows))
                             + "</tr>")
        parts.append(f"<div><h3>{html.escape(c.words)}</h3>{rows_of(lines, ['KG %', *c.targets])}</div>")
    return f'<div class="side">{"".join(parts)}</div>'


def ablation_table(results):
    found = results.ablations()
    if not found:
        return ""
    lines = []
    for name, by_target in found.items():
        means = [statistics.mean(p for _, p in pairs) if pairs else None for pairs in by_target.values()]
        widest = max((abs(m) for m in means if m is not None), default=0)
        bar = f'<span class="bar" style="width:{min(260, 4 * widest):.0f}px"></span>'
        lines.append("<tr>" + cells(html.escape(figures.BY_NAME[name].words),
                                    *("–" if m is None else f"{m:+.1f} %" for m in means),
                                    f'<td style="text-align:left">{bar}</td>') + "</tr>")
    targets = [target.replace("kg=", "KG ") for target in next(iter(found.values()))]
    return ("<h2>What each coding tool is worth</h2><p class='soft'>Bytes of the whole file that are added when one "
            "tool is switched off in encoder and decoder alike, mean over the sequences.</p>"
            + rows_of(lines, ["", *targets, ""]))


def effort_table(results):
    lines = [f"<tr>{cells(html.escape(c.words), f'{100 * (rate - 1):+.2f} %', f'{time:.2f} ×')}</tr>"
             for c, rate, time in results.efforts()]
    return ("<h2>Effort</h2><p class='soft'>Bytes and encoding time against the default effort.</p>"
            + rows_of(lines, ["", "bytes", "time"])) if lines else ""


def speed_table(results):
    lines = []
    for c in results.group("profile") + results.group("peer"):
        pairs = []
        for s in results.sequences:
            row = results.at(s, c.name, SPEED_TARGET) or results.at(s, c.name, "bits=11") or results.at(
                s, c.name, "accuracy=0.001")
            if row:
                pairs.append(row)
        if not pairs:
            continue
        million = sum(r["vertices"] * r["frames"] for r in pairs) / 1e6
        lines.append("<tr>" + cells(html.escape(c.words), html.escape(pairs[0]["target"]),
                                    f"{million / sum(r['encode_s'] for r in pairs):.3g}",
                                    f"{million / sum(r['decode_s'] for r in pairs):.3g}",
                                    f"{max(r['encode_mb'] for r in pairs):.0f}",
                                    f"{max(r['decode_mb'] for r in pairs):.0f}") + "</tr>")
    return rows_of(lines, ["", "setting", "encoding, million vertices a second", "decoding", "encoding, MiB at most",
                           "decoding, MiB"])


def lossless_table(results):
    names = results.group("lossless")
    lines = []
    for s in results.sequences:
        rows = [results.at(s, c.name, "lossless") for c in names]
        if any(rows):
            lines.append("<tr>" + cells(html.escape(s), *(f"{row['bpvf']:.2f}" if row else "–" for row in rows))
                         + "</tr>")
    return ("<h2>Lossless</h2><p class='soft'>Bits per vertex and frame; every coordinate comes back bit for bit.</p>"
            + rows_of(lines, ["", *(c.words for c in names)])) if lines else ""


def method(command):
    return f"""<h2>How this was measured</h2>
<p>Rates count every byte of a file, connectivity and headers too. KG is the error of Karni and Gotsman in percent;
STED the spatio-temporal edge difference of Vasa and Skala, which follows what people see. Each sequence is encoded,
decoded by the plain decoder of the codec and compared with the input. BD-rate is the average difference of rate at
equal error over the errors that both curves reach, by monotone cubic interpolation of the logarithms. Times are
processor seconds of whole commands on one thread, files read and written; memory is the largest resident set, which
the measuring program itself keeps from going below some 23 MiB. Draco codes frame by frame at its strongest setting
and does not keep the vertex order, nor does PCA; both are spared its cost. Every line of the table holds the command
that made it.</p>
<pre>{html.escape(command)}</pre>"""


def page(results, pictures, command):
    def read(name):
        with open(os.path.join(HERE, name), encoding="utf-8") as file:
            return file.read()

    return f"""<!doctype html><html lang="en"><meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1"><title>Reeb: rate and distortion</title>
<style>{read("report.css")}</style><main>
<header><h1>Reeb: rate and distortion</h1><p class="soft">Animated meshes compressed by Reeb and by other codecs:
{len(results.sequences)} sequences, {len(results.rows)} encodings, every one decoded and compared.</p></header>
{headline(results)}
<h2>Curves</h2><p class="soft">Lower and further left is better. Point at a dot for its figures; the buttons hide and
show codecs, and choose the error.</p>
{legend(results)}{sequence_cards(results, pictures)}
<h2>BD-rate against Reeb's default</h2><p class="soft">Rate that the others add (orange) or save (green) at equal KG
error; from three times the rate on, how many times.</p>{bd_table(results, "kg")}
<h3>At equal STED</h3>{bd_table(results, "sted")}
{ablation_table(results)}{effort_table(results)}
<h2>Rates</h2><p class="soft">Bits per vertex and frame at a KG error in percent.</p>{rate_table(results)}
<h2>Speed and memory</h2>{speed_table(results)}
{lossless_table(results)}{method(command)}
</main><script>{read("report.js")}</script></html>
"""


def pictures_of(found, reeb, wanted):
    """PNG strips in base64 by the name of the sequence."""
    out = {}
    with tempfile.TemporaryDirectory() as folder:
        for sequence in found:
            if sequence.name not in wanted:
                continue
            picture = os.path.join(folder, sequence.name + ".png")
            process.run([reeb, "picture", sequence.inputs[-1], "-o", picture, "--tile", "260", "-q"])
            with open(picture, "rb") as file:
                out[sequence.name] = base64.b64encode(file.read()).decode()
    return out


def arguments_of(words):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("table", help="that rate_distortion.py wrote")
    parser.add_argument("folders", nargs="*", metavar="FOLDER", help="of the sequences, for pictures of them")
    parser.add_argument("-o", "--output", help="the page")
    parser.add_argument("--svg", help="curves alone, one plot a sequence")
    parser.add_argument("--only", nargs="+", metavar="NAME", help="these sequences, in this order")
    parser.add_argument("--reeb", default=os.path.join(ROOT, "build", "tools", "reeb"), help="draws the pictures")
    arguments = parser.parse_args(words)
    if not arguments.output and not arguments.svg:
        parser.error("name a page with -o or a drawing with --svg")
    return arguments


def main(words=None):
    arguments = arguments_of(words)
    rows = table.read(arguments.table)
    if arguments.only:
        rows = {key: row for key, row in rows.items() if row["sequence"] in arguments.only}
    if not rows:
        raise SystemExit(f"{arguments.table}: has no such lines")
    results = figures.Results(rows)
    if arguments.svg:
        panels = [(s, results.curves(s, "kg")) for s in arguments.only or results.sequences]
        with open(arguments.svg, "w", encoding="utf-8") as file:
            file.write(curves.sheet(panels))
    if arguments.output:
        pictures = pictures_of(sequences.find(arguments.folders), arguments.reeb, results.sequences)
        name = os.path.basename(arguments.table)
        command = f"conformance/rd/rate_distortion.py SEQUENCES --configurations all --csv {name}"
        with open(arguments.output, "w", encoding="utf-8") as file:
            file.write(page(results, pictures, command))
    return 0


if __name__ == "__main__":
    sys.exit(main())
