#!/usr/bin/env python3
"""man_page.py REEB VERSION: writes the manual page reeb(1) to standard output, made from what `reeb --help` and
`reeb COMMAND --help` say, so that both always agree."""
import os
import re
import subprocess
import sys


def read_help(reeb, *command):
    """Lines of a help page, none of them broken."""
    wide = dict(os.environ, COLUMNS="10000")
    text = subprocess.run([reeb, *command, "--help"], check=True, capture_output=True, text=True, env=wide).stdout
    return text.splitlines()


def parse(lines):
    """The first line, the usage, and groups of entries: [(title, [(name, text)])]."""
    groups = []
    for line in lines[1:]:
        entry = re.match(r"  (\S.*?)(?:  +(\S.*))?$", line)
        if re.fullmatch(r"\S.*:", line):
            groups.append((line[:-1], []))
        elif groups and entry:
            groups[-1][1].append((entry[1], entry[2] or ""))
        elif groups and groups[-1][1] and re.match(r"   {10,}\S", line):
            name, text = groups[-1][1][-1]
            groups[-1][1][-1] = (name, (text + " " + line.strip()).strip())
    usage = next(line for line in lines if line.startswith("Usage: "))
    return lines[0], usage[len("Usage: "):], groups


def roff(text):
    text = text.replace("\\", "\\e").replace("-", "\\-")
    return "\\&" + text if text[:1] in (".", "'") else text


def entry_name(name):
    """`-o,--output FILE REQUIRED` as it is typed, and a remark."""
    remark = " Required." if name.endswith(" REQUIRED") else ""
    return name.removesuffix(" REQUIRED").replace(",", ", "), remark


def write_entries(out, entries):
    for name, text in entries:
        typed, remark = entry_name(name)
        end = "" if text.endswith(".") or not text else "."
        out += [".TP", f".B {roff(typed)}", roff(text + end + remark)]


def write_command(out, reeb, command):
    what, usage, groups = parse(read_help(reeb, command))
    out += [f".SS {roff('reeb ' + command)}", roff(what + "."), ".PP", f".B {roff(usage)}"]
    for title, entries in groups:
        if title not in ("Options", "Positionals"):
            out += [".PP", f".I {roff(title)}"]
        write_entries(out, [e for e in entries if not e[0].startswith("-h,")])


def main(reeb, version):
    what, _, groups = parse(read_help(reeb))
    commands = dict(groups)["Subcommands"]
    exit_codes = next(line for line in read_help(reeb) if line.startswith("Exit codes: "))
    out = [f'.TH REEB 1 "" "reeb {roff(version)}" "User Commands"', ".SH NAME",
           "reeb \\- " + roff(what.split(".")[0].lower()), ".SH SYNOPSIS", ".B reeb", ".I COMMAND",
           "[OPTION...]", ".br", ".B reeb \\-\\-version", ".br", ".B reeb", ".I COMMAND",
           ".B \\-\\-help", ".SH COMMANDS"]
    write_entries(out, commands)
    out.append(".SH OPTIONS")
    for command, _ in commands:
        write_command(out, reeb, command)
    out += [".SH EXIT STATUS", roff(exit_codes[len("Exit codes: "):] + ".")]
    print("\n".join(out))


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    main(sys.argv[1], sys.argv[2])
