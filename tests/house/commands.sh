#!/usr/bin/env bash
# Every command of the program in a README, in a code block or between backquotes, has a verb and options that exist, and
# its files below cases/ and scripts/ are there. Usage: commands.sh DRAPEPLAN SOURCE_DIR
set -uo pipefail
program=$1
cd "$2" || exit 1
failures=0 commands=0
fail() { echo "FAILED: $*" >&2; failures=$((failures + 1)); }

declare -A help
help_of() {  # a verb's help, asked for once
  [ -n "${help[$1]+known}" ] || help[$1]=$("$program" "$1" --help 2>/dev/null)
}
# check README COMMAND: all words after `drapeplan`, or after a script of ours.
check() {
  local readme=$1 command=${2%% #*} verb word
  read -r verb word <<<"$command"
  [[ $verb =~ ^[a-z]+$ ]] || return 0   # `drapeplan VERB`, a table's placeholder
  commands=$((commands + 1))
  help_of "$verb"
  [ -n "${help[$verb]}" ] || { fail "$readme: there is no verb: drapeplan $command"; return; }
  while read -r word; do
    grep -qE -- "(^| |,)$word( |,|$)" <<<"${help[$verb]}" || fail "$readme: no option $word: drapeplan $command"
  done < <(grep -oE '(^| )--[a-z][a-z-]*' <<<"$command" | tr -d ' ')
}
while IFS= read -r readme; do
  text=$(tr '\n' ' ' <"$readme" | sed 's/  */ /g')
  # Between backquotes, also over the end of a line; then in indented blocks.
  while IFS= read -r command; do check "$readme" "$command"; done < <(
    grep -oE '`[^`]*`' <<<"$text" | sed -nE 's/^`(build\/release\/)?drapeplan (.*)`$/\2/p; s/^`scripts\/run ?(.*)`$/plan \1/p'
    sed -nE 's/^    +(build\/[a-z]+\/)?drapeplan (.*)/\2/p; s/^    +scripts\/run ?(.*)/plan \1/p' "$readme")
  while IFS= read -r file; do
    [[ -e $file || $file == cases/mine.json ]] || fail "$readme: names $file, which is not there"
  done < <(grep -oE '(^|[ `(])(cases|scripts)/[A-Za-z0-9_./-]+' "$readme" | sed -E 's/^[ `(]//; s/[.,]$//' | sort -u)
done < <(find . -name README.md -not -path './build/*' -not -path './.git/*' | sort)
[ $commands -ge 40 ] || fail "only $commands commands were found"
echo "$commands commands, $failures failed"
[ $failures = 0 ]
