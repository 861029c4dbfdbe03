#!/usr/bin/env bash
# Nothing lost: one owner per folder, earlier results set aside, other verbs' results and other files left alone, places
# tried before the work.
# Usage: nothing_lost.sh DRAPEPLAN SOURCE_DIR JSON_VALUE
set -uo pipefail
. "$(dirname "$0")/kit.sh"
few=(--set optimise.evaluations=1 --set optimise.finalists=1
  --set 'fem.mesh_size=40 mm' --set fem.time_scaling=30 --set 'fidelities={}')
strip=(simulate "$source/cases/cantilever-150.json" --quiet --set 'duration=2 ms' --set 'fem.mesh_size=25 mm')
there() { for file in "$@"; do checks=$((checks + 1)); [ -e "$file" ] || fail "$file is not there"; done; }
gone() { for file in "$@"; do checks=$((checks + 1)); [ ! -e "$file" ] || fail "$file is there"; done; }
all_files() { (cd "$1" && find . -type f ! -name run.lock -exec cksum {} + | sort); }

# A second plan while the first one works: refused, and the first one ends as if alone.
run=$work/run
"$program" plan "$quick" --quiet --out "$run" "${few[@]}" --set optimise.evaluations=200 &
first=$!
for _ in $(seq 600); do [ -s "$run/evaluations.jsonl" ] && break; sleep 0.1; done
expect 2 plan "$quick" --out "$run" "${few[@]}"
says "another run works in this folder"
says "process"
expect 2 simulate "$quick" --out "$run" "${few[@]}"
same 1 "$(grep -c case_hash "$run/evaluations.jsonl")" "logs in one file"
# Killed: the folder is free again, and its log is resumed, or set aside if --resume was forgotten.
{ kill -9 $first && wait $first; } 2>/dev/null
killed=$(wc -l <"$run/evaluations.jsonl")
expect 0 plan "$quick" --out "$run" "${few[@]}"
says "$run/earlier-1"
there "$run/earlier-1/evaluations.jsonl" "$run/earlier-1/resolved.json" "$run/schedule.csv"
[ "$(wc -l <"$run/earlier-1/evaluations.jsonl")" -ge "$((killed - 1))" ] || fail "evaluations were lost"

# --resume with another case changes nothing; words do not make another case.
before=$(all_files "$run")
expect 2 plan "$quick" --resume --out "$run" "${few[@]}" --set friction.coefficient=0.3
says "belongs to another case"
same "$before" "$(all_files "$run")" "files after a refused --resume"
cp "$run/evaluations.jsonl" "$work/log"
expect 0 plan "$quick" --resume --quiet --out "$run" "${few[@]}" --set name=other --set grippers.source=other
same_file "$run/evaluations.jsonl" "$work/log"
there "$run/earlier-2/result.json"

# A plan that fails leaves no schedule of an earlier one.
expect 3 plan "$quick" --out "$run" "${few[@]}" --set fem.contact_stiffness=100 --set fem.step_safety=1 --set fem.bulk_viscosity=1
gone "$run/schedule.csv" "$run/schedule.json" "$run/report.html" "$run/optimised.pvd"
there "$run/earlier-3/schedule.csv" "$run/result.json"
lacks "$run/result.json" /best/schedule

# No verb writes over another's results.
before=$(all_files "$run")
for verb in map reach simulate check study bench; do
  expect 2 "$verb" "$quick" --out "$run"
  says 'holds results of `plan`'
done
expect 2 stress --only "size: two elements" --out "$run"
expect 2 schema --out "$run"
same "$before" "$(all_files "$run")" "files after the refusals"
expect 0 map "$quick" --quiet --out "$work/map"
expect 2 plan "$quick" --out "$work/map" "${few[@]}"
says 'holds results of `map`'

# Fewer frames than before: none of the earlier run stays among them. Files of others stay.
expect 0 "${strip[@]}" --out "$work/sim" --frames 7
echo mine >"$work/sim/notes.txt"
expect 0 "${strip[@]}" --out "$work/sim" --frames 2
same 2 "$(ls "$work/sim"/*.vtu | wc -l)" "frames of the second run"
same 7 "$(ls "$work/sim/earlier-1"/*.vtu | wc -l)" "frames of the first run"
same mine "$(cat "$work/sim/notes.txt")" "a file of others"
# Results of which nothing says whose they are.
mkdir "$work/foreign" && echo '{}' >"$work/foreign/result.json"
expect 2 "${strip[@]}" --out "$work/foreign"
same '{}' "$(cat "$work/foreign/result.json")" "a foreign result"
gone "$work/foreign/run.lock"

# --save replaces a saved state or nothing, and its place is tried before the run; so is that of --out.
pause=(--pause '1 ms' --save)
cp "$quick" "$work/mine.json" && mkfifo "$work/pipe" && mkdir "$work/folder" && ln -s mine.json "$work/link"
for place in mine.json pipe folder link; do
  expect 2 "${strip[@]}" "${pause[@]}" "$work/$place"
  says "$work/$place"
done
expect 2 "${strip[@]}" "${pause[@]}" /dev/null
same_file "$work/mine.json" "$quick"
[ -p "$work/pipe" ] && [ -d "$work/folder" ] && [ -L "$work/link" ] || fail "a place of --save was replaced"
expect 2 "${strip[@]}" "${pause[@]}" "$work/none/state" --out "$work/none2/a"
gone "$work/none2" "$work/none"
expect 2 "${strip[@]}" --out "$work/mine.json/run"
for _ in 1 2; do expect 0 "${strip[@]}" "${pause[@]}" "$work/x.state" --out "$work/saved"; done
there "$work/x.state" "$work/saved/result.json"
expect 2 "${strip[@]}" "${pause[@]}" "$work/saved/result.json" --out "$work/saved"
if [ "$(id -u)" != 0 ]; then
  mkdir -m 555 "$work/read-only"
  expect 2 "${strip[@]}" --out "$work/read-only"
  says "Permission denied"
fi
finish 69
