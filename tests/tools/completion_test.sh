#!/usr/bin/env bash
# completion_test.sh REEB FOLDER: the completions in FOLDER offer every command and option that --help does, and the
# values of options that have some; each shell that is there takes its file.
set -euo pipefail

reeb=$1
folder=$2
fail() { echo "$1"; exit 1; }

source "$folder/completion.bash"
# What bash offers behind the words given, the last one half typed.
offered() {
  COMP_WORDS=(reeb "$@")
  COMP_CWORD=$#
  COMPREPLY=()
  _reeb
  echo "${COMPREPLY[*]}"
}

count=0
commands=$("$reeb" --help | sed -n '/^Subcommands:/,/^$/s/^  \([a-z]*\) .*/\1/p')
for command in $commands; do
  [[ " $(offered "${command:0:2}") " == *" $command "* ]] || fail "bash does not offer $command"
  for shell in bash zsh fish; do
    grep -qw -- "$command" "$folder/completion.$shell" || fail "$shell lacks $command"
  done
  for option in $("$reeb" "$command" --help | grep -oE '^  (-[a-zA-Z],)?--[a-z-]+' | grep -oE -- '--[a-z-]+'); do
    [[ " $(offered "$command" x "${option:0:4}") " == *" $option "* ]] || fail "bash does not offer $command $option"
    grep -E "^    $command\) " "$folder/completion.zsh" | grep -qE -- "[ ,{]$option['},]" || fail "zsh lacks $command $option"
    grep -qE -- "_from $command' .*-l ${option#--} " "$folder/completion.fish" || fail "fish lacks $command $option"
    count=$((count + 1))
  done
done
[[ $count -ge 60 ]] || fail "only $count options were found"
[[ $(offered encode a.obj --profile f) == fast ]] || fail "values of --profile"
[[ $(offered decode a.reeb --progress "") == "auto always never" ]] || fail "values of --progress"
[[ $(offered help enc) == encode ]] || fail "help COMMAND"
[[ -z $(offered encode wal) ]] || fail "files are left to bash"

for shell in zsh fish; do
  if command -v $shell >/dev/null; then $shell -n "$folder/completion.$shell" || fail "$shell does not read its file"; fi
done
echo "$count options are offered"
