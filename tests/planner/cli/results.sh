#!/usr/bin/env bash
# Good input: the documents that scripts rely on, and a resolved case that gives the same result again.
# Usage: results.sh DRAPEPLAN SOURCE_DIR
set -uo pipefail
program=$1 source=$2
work=$(mktemp -d) && trap 'rm -rf "$work"' EXIT
failures=0
fail() { echo "FAILED: $*" >&2; failures=$((failures + 1)); }
run() { "$program" "$@" >"$work/stdout" 2>"$work/stderr" || fail "exit $?: $*: $(head -c 400 "$work/stderr")"; }
has() { for key in "$@"; do grep -qF "\"$key\"" "$work/stdout" || fail "no $key in the result"; done; }

run check "$source"/cases/*.json "$source"/tests/bench/cases/*.json
run schema
has grippers joint_offset
run explain grippers
run map "$source/cases/flexdraper-quick.json" --json --out "$work/out"
has targets gripper position boundary max_shear_deg mean_shear_deg corners
cmp -s "$work/stdout" "$work/out/result.json" || fail "result.json differs from --json"
[ "$(head -n 1 "$work/out/net.csv")" = u,v,x,y,z,shear_deg ] || fail "net.csv has another head"
awk -F, 'NR > 1 && NF != 6 {bad = 1} END {exit bad || NR < 100}' "$work/out/net.csv" || fail "net.csv is no table of the net"
for file in net.vtu net.pvd boundary.pvd targets.pvd pattern.dxf; do [ -s "$work/out/$file" ] || fail "no $file"; done
cp "$work/stdout" "$work/first"
run map "$work/out/resolved.json" --json
cmp -s "$work/stdout" "$work/first" || fail "the resolved case gives another result"
run map "$source/cases/plane-mapping.json" --quiet
[ -s "$work/stdout" ] && fail "--quiet is not quiet"
run reach "$source/cases/flexdraper-quick.json" --json
has floor_max floor_rms per_gripper link_violation status
# What cannot be written to stdout is an error that is named, and files are kept.
full() {
  "$program" "$@" >/dev/full 2>"$work/stderr"
  local got=$?
  [ "$got" = 3 ] || fail "exit $got instead of 3 on a full disk: $*"
  grep -qF 'stdout: cannot be written' "$work/stderr" || fail "a full disk is not named: $*"
}
full map "$source/cases/plane-mapping.json" --out "$work/full"
[ -s "$work/full/result.json" ] || fail "no result.json because stdout is full"
full map "$source/cases/plane-mapping.json" --json
full schema
full --help
[ $failures = 0 ]
