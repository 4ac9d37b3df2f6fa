#!/usr/bin/env bash
# man_page_test.sh REEB PAGE: the manual page names every command and every option that --help does, and formats
# without a warning.
set -euo pipefail

reeb=$1
page=$2
text=$(sed 's/\\-/-/g; s/\\e/\\/g' "$page")
commands=$("$reeb" --help | sed -n '/^Subcommands:/,/^$/s/^  \([a-z]*\) .*/\1/p')
[[ $(wc -w <<<"$commands") -ge 8 ]]
count=0
for command in $commands; do
  grep -qF "reeb $command" <<<"$text" || { echo "the page lacks the command $command"; exit 1; }
  for option in $("$reeb" "$command" --help | grep -oE '^  (-[a-zA-Z],)?--[a-z-]+' | grep -oE -- '--[a-z-]+'); do
    [[ $option == --help ]] && continue
    grep -qE -- "^\.B (-[a-zA-Z], )?$option( |$)" <<<"$text" || { echo "the page lacks $command $option"; exit 1; }
    count=$((count + 1))
  done
done
[[ $count -ge 40 ]]
if command -v groff >/dev/null; then
  warnings=$(groff -man -ww -z "$page" 2>&1)
  [[ -z $warnings ]] || { echo "$warnings"; exit 1; }
fi
echo "$count options are on the page"
