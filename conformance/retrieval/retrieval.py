#!/usr/bin/env python3
"""How well shapes of one class find each other, by Reeb charts and by plain methods. See README.md."""

import argparse
import csv
import html
import math
import pathlib
import subprocess
import sys
import tempfile

import scores

MESHES = {'.obj', '.ply', '.off', '.stl', '.reeb'}
COLOURS = ['#c0392b', '#e67e22', '#8e44ad', '#2980b9', '#27ae60', '#16a085', '#7f8c8d']


def items_of_folder(folder):
    """A class is a folder in it."""
    for path in sorted(folder.rglob('*')):
        if path.suffix.lower() in MESHES and path.parent != folder:
            yield path.relative_to(folder).parts[0], str(path), '1', '-'


def items_of_list(path):
    """Lines of class, file and, where they are not 1 and -, frame and variant, separated by tabs."""
    for line in path.read_text().splitlines():
        if line.strip():
            fields = line.split('\t')
            yield tuple(fields + ['1', '-'][len(fields) - 2:])


def with_variants(items, count, program):
    """The items, and of the first `count` of each class every variant."""
    names = subprocess.run([program, '--variants'], check=True, capture_output=True, text=True).stdout.split()
    seen, chosen = {}, []
    for kind, file, frame, variant in items:
        if variant == '-' and seen.setdefault(kind, 0) < count:
            seen[kind] += 1
            chosen += [(kind, file, frame, name) for name in names]
    return items + chosen


def read_distances(path, count):
    """Matrix by method, the seconds that signing took, and those that comparing two signatures takes."""
    lines = path.read_text().splitlines()
    matrices = {}
    while lines[0] != 'seconds':
        rows = lines[1:count + 1]
        matrices[lines[0]] = [[float(x) for x in row.split()] for row in rows]
        lines = lines[count + 1:]
    return matrices, [float(x) for x in lines[1].split()], float(lines[3].split()[0])


def measure(program, items):
    with tempfile.TemporaryDirectory() as folder:
        listing, output = pathlib.Path(folder, 'list'), pathlib.Path(folder, 'distances')
        listing.write_text(''.join('\t'.join(item) + '\n' for item in items))
        subprocess.run([program, listing, output], check=True)
        return read_distances(output, len(items))


def all_among_all(matrices, items):
    """Every shape is searched for among all others."""
    kinds = [item[0] for item in items]
    everything = range(len(items))  # rows and columns beyond are those of variants that were added
    return {method: scores.evaluate(m, kinds, everything, lambda query: [i for i in everything if i != query])
            for method, m in matrices.items()}


def variant_among_originals(matrices, items, variant):
    """Shapes of one variant are searched for among the shapes that are none, the one they are made from left out."""
    kinds = [item[0] for item in items]
    queries = [i for i, item in enumerate(items) if item[3] == variant]
    originals = [i for i, item in enumerate(items) if item[3] == '-']
    return {method: scores.evaluate(m, kinds, queries, lambda query: [i for i in originals if items[i][1:3] != items[query][1:3]])
            for method, m in matrices.items()}


def invariance(matrices, items):
    """For each variant, and for the other poses of a class: how far it is from what it is made from, where shapes of
    different classes are 1 from each other in the mean, and how often that is the nearest of all, the class the right one."""
    kinds = [item[0] for item in items]
    originals = [i for i, item in enumerate(items) if item[3] == '-']
    place = {items[i][1:3]: i for i in originals}
    rows = []
    for variant in sorted({item[3] for item in items}):
        queries = [i for i, item in enumerate(items) if item[3] == variant and item[1:3] in place]
        for method, m in matrices.items():
            apart = scores.mean(m[i][j] for i in originals for j in originals if kinds[i] != kinds[j])
            if variant == '-':
                moved = scores.mean(m[i][j] for i in originals for j in originals if i != j and kinds[i] == kinds[j])
                found = [scores.nearest(m, q, [i for i in originals if i != q]) for q in queries]
                itself = math.nan
            else:
                moved = scores.mean(m[q][place[items[q][1:3]]] for q in queries)
                found = [scores.nearest(m, q, originals) for q in queries]
                itself = scores.mean(float(f == place[items[q][1:3]]) for q, f in zip(queries, found))
            right = scores.mean(float(kinds[f] == kinds[q]) for q, f in zip(queries, found))
            rows.append((variant if variant != '-' else 'pose', method, len(queries), moved / apart, itself, right))
    return rows


def print_invariance(rows):
    print(f"\n{'':14}{'':24}{'shapes':>8}{'distance':>10}{'found, %':>10}{'class, %':>10}")
    for variant, method, count, moved, itself, right in rows:
        print(f'{variant:14}{method:24}{count:8}{moved:10.3f}{100 * itself:10.1f}{100 * right:10.1f}')


def write_invariance(path, name, rows, append):
    with open(path, 'a' if append else 'w', newline='') as out:
        table = csv.writer(out)
        if not append:
            table.writerow(['set', 'variant', 'method', 'shapes', 'distance from the original, 1 = other classes',
                            'original found first, %', 'nearest of its class, %'])
        for variant, method, count, moved, itself, right in rows:
            table.writerow([name, variant, method, count, f'{moved:.4f}', '' if math.isnan(itself) else f'{100 * itself:.1f}',
                            f'{100 * right:.1f}'])


def write_csv(path, tables, append):
    with open(path, 'a' if append else 'w', newline='') as out:
        table = csv.writer(out)
        if not append:
            table.writerow(['set', 'method', *scores.MEASURES]
                           + [f'precision at recall {i / scores.RECALL_STEPS:g}' for i in range(1, scores.RECALL_STEPS + 1)])
        for title, results in tables.items():
            for method, (values, curve) in results.items():
                table.writerow([title, method, *(f'{100 * v:.1f}' for v in values), *(f'{v:.3f}' for v in curve)])


def svg(name, results):
    """Precision over recall."""
    left, top, width, height = 60, 40, 460, 320
    parts = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{left + width + 220}" height="{top + height + 60}" '
             'font-family="sans-serif" font-size="13">',
             '<rect width="100%" height="100%" fill="white"/>',
             f'<text x="{left}" y="24" font-size="15">{html.escape(name)}</text>']
    for i in range(6):
        x, y = left + width * i / 5, top + height * (1 - i / 5)
        parts.append(f'<path d="M{left} {y:.1f}h{width}M{x:.1f} {top}v{height}" stroke="#ddd" fill="none"/>'
                     f'<text x="{x:.1f}" y="{top + height + 18}" text-anchor="middle">{i / 5:g}</text>'
                     f'<text x="{left - 8}" y="{y + 4:.1f}" text-anchor="end">{i / 5:g}</text>')
    parts.append(f'<text x="{left + width / 2}" y="{top + height + 40}" text-anchor="middle">recall</text>'
                 f'<text transform="translate(18 {top + height / 2}) rotate(-90)" text-anchor="middle">precision</text>')
    for k, (method, (_, curve)) in enumerate(results.items()):
        colour = COLOURS[k % len(COLOURS)]
        points = ' '.join(f'{left + width * (i + 1) / len(curve):.1f},{top + height * (1 - p):.1f}' for i, p in enumerate(curve))
        parts.append(f'<polyline points="{points}" fill="none" stroke="{colour}" stroke-width="2"/>'
                     f'<path d="M{left + width + 16} {top + 14 + 22 * k}h22" stroke="{colour}" stroke-width="3"/>'
                     f'<text x="{left + width + 44}" y="{top + 18 + 22 * k}">{html.escape(method)}</text>')
    return '\n'.join(parts + ['</svg>', ''])


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('input', type=pathlib.Path, help='a folder with a folder per class, or a list: class, file[, frame[, variant]]')
    parser.add_argument('--name', help='of the set, in the table; default: that of the input')
    parser.add_argument('--program', default='build/conformance/retrieval/retrieval_distances')
    parser.add_argument('--variants-of', type=int, default=0, metavar='N', help='adds all variants of the first N shapes of each class')
    parser.add_argument('--invariance', metavar='CSV', help='what variants and poses change is written there')
    parser.add_argument('--variants-only', action='store_true', help='no scores of all shapes among all')
    parser.add_argument('--csv', help='scores and curves are written there')
    parser.add_argument('--append', action='store_true', help='to the rows of the CSV file that are there')
    parser.add_argument('--svg', type=pathlib.Path, help='the precision-recall curves')
    args = parser.parse_args()
    items = list(items_of_folder(args.input) if args.input.is_dir() else items_of_list(args.input))
    if not items:
        sys.exit(f'{args.input}: no shapes; give a folder with a folder of meshes per class, or a list')
    given = items
    items = with_variants(items, args.variants_of, args.program)
    matrices, seconds, comparison = measure(args.program, items)
    name = args.name or args.input.stem
    print(f'{name}: {len(items)} shapes, {len({item[0] for item in items})} classes; signed in '
          f'{sum(seconds) / len(seconds):.2f} s of processor time each, at most {max(seconds):.2f} s; one compared with 1,000 in '
          f'{1000 * comparison:.2f} s')
    tables = {name: all_among_all(matrices, given)} if not args.variants_only else {}
    for variant in sorted({item[3] for item in items} - {'-'}):
        tables[f'{name}, {variant}'] = variant_among_originals(matrices, items, variant)
    tables = {title: results for title, results in tables.items() if all(values for values, _ in results.values())}
    for title, results in tables.items():
        print(f'\n{title:32}' + ''.join(f'{m:>18}' for m in scores.MEASURES))
        for method, (values, _) in results.items():
            print(f'{method:32}' + ''.join(f'{100 * v:18.1f}' for v in values))
    rows = invariance(matrices, items)
    print_invariance(rows)
    if args.invariance:
        write_invariance(args.invariance, name, rows, args.append)
    if args.csv:
        write_csv(args.csv, tables, args.append)
    if args.svg:
        args.svg.write_text(svg(*next(iter(tables.items()))))


if __name__ == '__main__':
    main()
