#!/usr/bin/env python3
"""Walks through what the command promises as somebody new to it does: real spellings of files, odd names, targets of
all sizes, damaged files, closed doors. Prints a line for every demand, and what was expected and seen where they differ.

Usage: tests/walk/walk.py REEB_COMMAND [SECTION...] [--all]
"""
import os
import sys

import commands
import encoding
import reading
from demands import Walk

SECTIONS = {step.__name__: step for part in (reading, encoding, commands) for step in part.STEPS}


def short(value):
    text = str(value).replace("\n", " / ")
    return text if len(text) < 300 else text[:297] + "..."


def report(results, show_all):
    """A line for each demand; gives the number of those that are not met."""
    demands = {}
    for what, wanted, seen, good in results:
        demands.setdefault(what, []).append((wanted, seen, good))
    failed = 0
    for what, checks in demands.items():
        bad = [check for check in checks if not check[2]]
        failed += bool(bad)
        print(f"{'FAILED' if bad else 'good'}: {what} ({len(checks)})")
        for wanted, seen, _ in checks if show_all else bad:
            print(f"    expected {short(wanted)}\n    seen     {short(seen)}")
    print(f"{len(demands) - failed} passed, {failed} failed")
    return failed


def main():
    names = [a for a in sys.argv[2:] if a != "--all"]
    if len(sys.argv) < 2 or not os.access(sys.argv[1], os.X_OK) or not set(names) <= set(SECTIONS):
        raise SystemExit(f"{__doc__}\nSections: {' '.join(SECTIONS)}")
    walk = Walk(sys.argv[1])
    for name in names or SECTIONS:
        SECTIONS[name](walk)
    return 1 if report(walk.results, "--all" in sys.argv) else 0


if __name__ == "__main__":
    sys.exit(main())
