#!/usr/bin/env bash
# A wrong input: exit 2, every error on stderr with its path, nothing on stdout, nothing written.
# Usage: bad_input.sh DRAPEPLAN SOURCE_DIR JSON_VALUE
set -uo pipefail
# shellcheck source=tests/planner/cli/kit.sh
. "$(dirname "$0")/kit.sh"

for bad in "$source"/tests/bad_cases/*.json; do
  for verb in check map reach; do
    expect 2 "$verb" "$bad" --out "$work/out"
    while IFS= read -r line; do
      grep -qF -- "$line" "$work/stderr" || fail "$verb $bad: no '$line' on stderr"
    done <"${bad%.json}.expected"
    [ -s "$work/stdout" ] && fail "$verb $bad: something on stdout"
    [ -e "$work/out" ] && fail "$verb $bad: something was written"
  done
done

expect 2                                             # no verb
expect 2 simulte "$quick"                             # no such verb
grep -qF 'there is no verb "simulte"; did you mean "simulate"?' "$work/stderr" || fail "no nearest verb"
expect 2 xyz                                         # nor one like it
grep -qF 'there is no verb "xyz"; expected "plan", ' "$work/stderr" || fail "verbs are not listed"
[ -s "$work/stdout" ] && fail "something on stdout without a verb"
expect 2 map                                         # no case
expect 2 map "$quick" --threads 0
# Cases without a fault in themselves that no run could begin: `check` finds them, too.
expect 2 check "$source/cases/sphere-mapping.json" --set 'mold.radius=60 mm' --json
same "$(value "$work/stdout" /cases/0/valid)" false "check of a mold that is too small"
value "$work/stdout" /cases/0/errors/0/message | grep -qF 'the mold ends beyond' || fail "check: $(cat "$work/stdout")"
refuse 'too large for this outline' check "$source/cases/bias-extension.json" --set 'fem.mesh_size=400 mm'
expect 0 check "$quick" --set 'mold.extent=[["200 mm", "250 mm"], ["200 mm", "250 mm"]]'
grep -qF 'warning: the mapped ply reaches' "$work/stdout" || fail "check without the warning: $(cat "$work/stdout")"
expect 2 map "$quick" --set ply.widht='1 mm'
grep -qF '/ply/widht: unknown key "widht"; did you mean "width"?' "$work/stderr" || fail "--set error without path"
expect 2 explain grippers.joint_ofset
grep -qF 'did you mean "grippers.joint_offset"?' "$work/stderr" || fail "explain without the nearest word"
expect 2 map "$source/cases/cantilever-150.json"     # no mapping
expect 2 reach "$source/cases/sphere-mapping.json"   # no grippers
expect 0 --help
expect 0 map --help
finish 160
