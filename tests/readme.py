#!/usr/bin/env python3
"""Runs the commands of README.md's sections "Use it", "Attributes" and "Embed it" as they stand, one after another.

Usage: tests/readme.py FOLDER_OF_THE_REEB_COMMAND [SECTION...]
"""
import os
import re
import subprocess
import sys
import tempfile

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
FOLDERS = {"Use it": None, "Attributes": None, "Embed it": ROOT}  # where they run; None: in an empty folder


def commands_of(text, section):
    """The indented lines of a section, as one script."""
    body = re.search(rf"^## {re.escape(section)}\n(.*?)(?=^## )", text, re.MULTILINE | re.DOTALL)
    lines = [line[4:] for line in body.group(1).splitlines() if line.startswith("    ")] if body else []
    if not lines:
        raise SystemExit(f"README.md: no commands under '{section}'")
    return lines


def run(section, lines, environment):
    with tempfile.TemporaryDirectory() as home:
        done = subprocess.run(["bash", "-e", "-o", "pipefail", "-x"], input="\n".join(lines), text=True,
                              cwd=FOLDERS[section] or home, env={**environment, "HOME": home}, capture_output=True)
    if done.returncode != 0:
        raise SystemExit(f"README.md, '{section}':\n{done.stdout}{done.stderr}exit code {done.returncode}")
    print(f"{section}: {len(lines)} lines run")


def main():
    if len(sys.argv) < 2:
        raise SystemExit(__doc__)
    with open(os.path.join(ROOT, "README.md"), encoding="utf-8") as file:
        text = file.read()
    path = os.path.abspath(sys.argv[1]) + os.pathsep + os.environ["PATH"]
    for section in sys.argv[2:] or FOLDERS:
        run(section, commands_of(text, section), {**os.environ, "PATH": path})


if __name__ == "__main__":
    main()
