"""The table of results: one line for each sequence, configuration and target."""
import csv
import os

# What identifies a line, what it measured, and what made it. Sizes in bytes, kg in percent, rmse and max_error in
# units of the input, *_s seconds of processor time, *_mb largest resident memory in MiB.
COLUMNS = ["sequence", "configuration", "target", "vertices", "frames", "bytes", "bpvf", "kg", "rmse", "max_error",
           "sted", "encode_s", "decode_s", "encode_mb", "decode_mb", "version", "command"]
NUMBERS = COLUMNS[3:15]


def key(row):
    return row["sequence"], row["configuration"], row["target"]


def read(path):
    """Lines of a table by their key, numbers as float (nan where empty); nothing where there is no file."""
    if not path or not os.path.exists(path):
        return {}
    rows = {}
    with open(path, newline="", encoding="utf-8") as lines:
        for row in csv.DictReader(lines):
            for name in NUMBERS:
                row[name] = float(row[name]) if row.get(name) else float("nan")
            rows[key(row)] = row
    return rows


def brief(value):
    """Six digits at most; empty for nan."""
    if value != value:
        return ""
    return str(int(value)) if value == int(value) and abs(value) < 1e15 else f"{value:.6g}"


def write(path, rows):
    """Replaces a table as a whole, lines in the order given."""
    scratch = path + ".part"
    with open(scratch, "w", newline="", encoding="utf-8") as lines:
        writer = csv.DictWriter(lines, COLUMNS, lineterminator="\n")
        writer.writeheader()
        for row in rows:
            writer.writerow({**row, **{name: brief(row[name]) for name in NUMBERS}})
    os.replace(scratch, path)
