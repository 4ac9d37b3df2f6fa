#!/usr/bin/env python3
"""completion.py REEB SHELL: writes completions of the command line for bash, zsh or fish to standard output, made from
what `reeb --help` and `reeb COMMAND --help` say, so that both always agree."""
import re
import sys

from man_page import parse, read_help


class Option:
    """One entry of a help page: `-o,--output FILE`, `--progress auto|always|never`, `--lossless`."""

    def __init__(self, entry, text):
        names, _, argument = entry.removesuffix(" REQUIRED").partition(" ")
        self.names = names.split(",")
        self.takes_value = argument != ""
        self.values = argument.split("|") if "|" in argument else []
        self.text = re.split(r"[;:(,]", text)[0].strip()


def read_commands(reeb):
    """[(name, text, [Option])] of all commands."""
    commands = []
    for name, text in dict(parse(read_help(reeb))[2])["Subcommands"]:
        groups = parse(read_help(reeb, name))[2]
        entries = [entry for title, group in groups if title != "Positionals" for entry in group]
        commands.append((name, text, [Option(*entry) for entry in entries]))
    return commands


def bash(commands):
    names = " ".join(name for name, _, _ in commands)
    options = "\n".join(f'      {name}) words="{" ".join(n for o in all_options for n in o.names)}" ;;'
                        for name, _, all_options in commands)
    values = "\n".join(f'    {name}:{"|".join(o.names)}) words="{" ".join(o.values)}" ;;'
                       for name, _, all_options in commands for o in all_options if o.values)
    return f"""# bash completion of reeb
_reeb() {{
  local cur=${{COMP_WORDS[COMP_CWORD]}} prev=${{COMP_WORDS[COMP_CWORD - 1]}} command= words= i
  for ((i = 1; i < COMP_CWORD; i++)); do
    [[ ${{COMP_WORDS[i]}} == -* ]] || {{ command=${{COMP_WORDS[i]}}; break; }}
  done
  case $command:$prev in
{values}
  esac
  if [[ -z $words && $cur == -* ]]; then
    case $command in
      "") words="-h --help --version" ;;
{options}
    esac
  elif [[ -z $words && ( -z $command || $command == help ) ]]; then
    words="{names}"
  fi
  [[ -z $words && $cur == -* ]] || COMPREPLY=($(compgen -W "$words" -- "$cur"))
}}
complete -o default -F _reeb reeb
"""


def zsh_option(option):
    text = option.text.replace("'", "’").replace("[", "(").replace("]", ")")
    value = f":{option.names[-1].lstrip('-')}:" if option.takes_value else ""
    if option.takes_value:
        value += f"({' '.join(option.values)})" if option.values else "_files"
    names = option.names[0] if len(option.names) == 1 else "{" + ",".join(option.names) + "}"
    return f"{names}'[{text}]{value}'"


def zsh(commands):
    listed = "\n".join(f"    '{name}:{text.replace(chr(39), '’')}'" for name, text, _ in commands)
    cases = "\n".join(f"    {name}) _arguments " + " ".join(map(zsh_option, options)) +
                      (" '*:command:_describe command commands'" if name == "help" else " '*:file:_files'") + " ;;"
                      for name, _, options in commands)
    return f"""#compdef reeb
_reeb() {{
  local -a commands=(
{listed}
  )
  if (( CURRENT == 2 )); then
    _describe command commands
    return
  fi
  local command=$words[2]
  shift words
  (( CURRENT-- ))
  case $command in
{cases}
  esac
}}
_reeb "$@"
"""


def fish_option(command, option):
    text = option.text.replace("\\", "\\\\").replace("'", "\\'")
    line = f"complete -c reeb -n '__fish_seen_subcommand_from {command}'"
    for name in option.names:
        line += f" -l {name[2:]}" if name.startswith("--") else f" -s {name[1:]}"
    if option.values:
        line += f" -x -a '{' '.join(option.values)}'"
    elif option.takes_value:
        line += " -r"
    return f"{line} -d '{text}'"


def fish(commands):
    lines = ["# fish completion of reeb"]
    for name, text, _ in commands:
        text = text.replace("'", "\\'")
        lines.append(f"complete -c reeb -f -n __fish_use_subcommand -a {name} -d '{text}'")
    names = " ".join(name for name, _, _ in commands)
    lines.append(f"complete -c reeb -f -n '__fish_seen_subcommand_from help' -a '{names}'")
    lines += [fish_option(name, option) for name, _, options in commands for option in options]
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    shells = {"bash": bash, "zsh": zsh, "fish": fish}
    if len(sys.argv) != 3 or sys.argv[2] not in shells:
        sys.exit(__doc__)
    sys.stdout.write(shells[sys.argv[2]](read_commands(sys.argv[1])))
