#!/usr/bin/env bash
# How a new user begins: a case to start from, the version, help by example, the man page, the completion in bash.
# Usage: new.sh DRAPEPLAN SOURCE_DIR JSON_VALUE
set -uo pipefail
. "$(dirname "$0")/kit.sh"

# Cases of several sizes and molds are good ones, and a file is never replaced.
cd "$work" || exit 1
mkdir cases
cp "$source/cases/molds/block.stl" tool.stl
made() {
  expect 0 new "cases/$1.json" "${@:2}"
  says "next: drapeplan check cases/$1.json" stdout
  expect 0 check "cases/$1.json"
}
made plain
made wide --ply 600x300 --grippers 4x3
made ball --mold sphere --grippers 3x3
made tool --mold stl=tool.stl --ply 205x205 --grippers 3x3
same '../tool.stl' "$(value cases/tool.json /mold/file)" "the mold's file, relative to the case"
same 4 "$(value cases/wide.json /grippers/columns)" columns
same '600 mm' "$(value cases/wide.json /ply/width)" width
same 'drapeplan-case-1.schema.json' "$(value cases/plain.json /\$schema)" "schema of a case"
expect 0 schema
same 'drapeplan-case-1.schema.json' "$(value stdout /\$id)" "id of the schema"
expect 0 new
same_file stdout cases/plain.json
before=$(cksum <cases/plain.json)
expect 2 new cases/plain.json --ply 100x100
says "is there already" stderr
same "$before" "$(cksum <cases/plain.json)" "a case that was there"
expect 0 simulate cases/ball.json --set 'fem={"mesh_size": "30 mm", "mass_scaling": 100, "time_scaling": 12}' --set score.kinetic_limit=20 --json
within stdout /score/max_gap 0 0.02
for wrong in '--ply 400' '--ply 0x3' '--ply axb' '--grippers 2.5x3' '--grippers 90x90' '--mold cone' '--mold stl' '--mold stl=absent.stl' '--out elsewhere'; do
  expect 2 new cases/wrong.json $wrong
  says "${wrong%% *}" stderr
  [ ! -e cases/wrong.json ] && [ ! -e elsewhere ] || fail "something was written: $wrong"
done
expect 2 new cases/wrong.json --mold sphere --unit '5 km'
says "--unit: is that of a file" stderr
expect 2 new ''
says "the name is empty" stderr

# Version and help; nothing is coloured.
expect 0 --version
says "instruction set: " stdout
expect 0 --help
says "drapeplan new mine.json" stdout
verbs=$(sed -n '/^Subcommands/,/^$/ s/^  \([a-z]*\) .*/\1/p' stdout)
same 14 "$(wc -w <<<"$verbs")" "verbs"
for verb in $verbs; do
  expect 0 "$verb" --help
  says "  drapeplan $verb" stdout
done
checks=$((checks + 1))
grep -q $'\033' stdout stderr && fail "escapes in the output"

# Every example of the help is one that the parser takes.
for verb in "" $verbs; do
  "$program" $verb --help | sed -n 's/^  drapeplan \(.*\)/\1/p'
done >examples
while read -r line; do
  eval "words=(${line%%>*})"
  expect 0 "${words[@]}" --help
done <examples

# The man page and the completion know all verbs and options.
expect 0 man
cp stdout drapeplan.1
for verb in $verbs; do says ".SS \"$verb" drapeplan.1; done
if command -v groff >/dev/null; then
  same "none" "$(groff -man -Tutf8 -wall -z drapeplan.1 2>&1 | head -3 | grep . || echo none)" "warnings of groff"
fi
expect 0 completion
cp stdout completion.bash
checks=$((checks + 1))
bash -n completion.bash || fail "the completion is no script"
# completes WANTED WORDS...: the last word is completed to what has the wanted word among it.
completes() {
  local wanted=$1
  shift
  checks=$((checks + 1))
  bash -c '. ./completion.bash; COMP_WORDS=(drapeplan "$@"); COMP_CWORD=$#; _drapeplan; printf "%s\n" "${COMPREPLY[@]}"' - "$@" |
    grep -qxF -- "$wanted" || fail "$* is not completed to $wanted"
}
completes simulate si
completes --budget plan --b
completes --resume plan a.json --r
completes wave simulate a.json --schedule w
completes tool.stl simulate a.json --schedule t
completes cases/plain.json check cases/p
completes cases plan a.json --out ca
completes cases report c

finish 90
