#!/usr/bin/env python3
"""Which files .ci/lint looks at, one a line: lint_files.py BUILD_FOLDER

Writes BUILD_FOLDER/lint/compile_commands.json, which has each of them once: a file of two libraries would be looked at
twice. Fails where source files hold what clang-tidy misses in files that are compiled as one unit: names that are
declared and not used, included source files.
"""
import json
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
FOLDERS = ("bindings", "bitstream", "codec", "conformance", "entropy", "retrieval", "segmentation", "tools")
DECLARED = re.compile(r"^\s*(?:using (?:typename )?[\w:]*::(\w+);|namespace (\w+) = )", re.MULTILINE)
SOURCE_INCLUDED = re.compile(r'^\s*#\s*include ".*\.c(?:pp)?"', re.MULTILINE)


def commands(build):
    """The command of each file, units of many files before single ones: they take long."""
    once = {c["file"]: c for c in json.loads((build / "compile_commands.json").read_text())}
    wanted = {}
    for name, command in once.items():
        for base in (build, ROOT):
            if base in pathlib.Path(name).parents:
                folder = pathlib.Path(name).relative_to(base).parts[0]
                if folder in FOLDERS and name.endswith((".cpp", ".cxx")):
                    wanted[name] = command
                break
    return dict(sorted(wanted.items(), key=lambda item: not item[0].endswith(".cxx")))


def faults(name, text):
    for match in DECLARED.finditer(text):
        word = match[1] or match[2]
        if len(re.findall(rf"\b{word}\b", text)) < 2:
            yield match.start(match.lastindex), f"{word} is declared and not used"
    for match in SOURCE_INCLUDED.finditer(text):
        yield match.end() - 1, "a source file is included"


def main():
    build = pathlib.Path(sys.argv[1]).resolve()
    chosen = commands(build)
    (build / "lint").mkdir(exist_ok=True)
    (build / "lint" / "compile_commands.json").write_text(json.dumps(list(chosen.values()), indent=1))
    print("\n".join(chosen))
    listed = subprocess.run(["git", "ls-files", "*.cpp"], cwd=ROOT, stdout=subprocess.PIPE, text=True, check=True).stdout
    found = 0
    for name in listed.split():
        text = (ROOT / name).read_text()
        for at, what in faults(name, text):
            print(f"{name}:{text.count(chr(10), 0, at) + 1}: {what}", file=sys.stderr)
            found += 1
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
