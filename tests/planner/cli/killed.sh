#!/usr/bin/env bash
# A plan that is killed, or interrupted, at any moment and resumed ends as one that was left alone.
# Usage: killed.sh DRAPEPLAN SOURCE_DIR JSON_VALUE [KILLS]
set -uo pipefail
. "$(dirname "$0")/kit.sh"
kills=${4:-5}
plan=(plan "$quick" --quiet --set 'fidelities.search={"mesh_size": "30 mm", "time_scaling": 30}' --set optimise.finalists=1
  --set 'fem.mesh_size=34 mm' --set fem.time_scaling=20 --set optimise.evaluations=60)
lines() { cat "$1/evaluations.jsonl" 2>/dev/null | wc -l; }

expect 0 "${plan[@]}" --out "$work/whole"
total=$(lines "$work/whole")
same_end() {
  same_file "$1/schedule.json" "$work/whole/schedule.json"
  for key in /history /evaluations /failed_evaluations /best/score /runs/best/state_hash; do
    same "$(value "$work/whole/result.json" $key)" "$(value "$1/result.json" $key)" "$key after $2"
  done
}

# killed TIMES RUN OPTIONS...: kills spread over the whole run, each a little after the log has grown to its share.
killed() {
  local times=$1 run=$2 resume= k job
  shift 2
  for k in $(seq "$times"); do
    "$program" "${plan[@]}" "$@" $resume --out "$run" 2>/dev/null &
    job=$!
    until [ "$(lines "$run")" -ge $((k * total / (times + 1))) ] || ! kill -0 $job 2>/dev/null; do sleep 0.02; done
    sleep "0.0$((RANDOM % 10))"
    { kill -9 $job && wait $job; } 2>/dev/null
    resume=--resume
  done
  expect 0 "${plan[@]}" "$@" --resume --out "$run"
}
killed "$kills" "$work/run"
same_end "$work/run" "$kills kills"

# Ctrl-C, once the baselines are known: what runs is finished, the best so far is written, 3.
run=$work/interrupted
"$program" "${plan[@]}" --out "$run" 2>"$work/stderr" &
job=$!
until [ "$(lines "$run")" -ge $((total / 3)) ] || ! kill -0 $job 2>/dev/null; do sleep 0.02; done
kill -INT $job
wait $job
same 3 $? "exit code of an interrupted plan"
same true "$(value "$run/result.json" /interrupted)" "interrupted"
value "$run/result.json" /message | grep -qF -- --resume || fail "the message does not name --resume"
for file in schedule.json schedule.csv report.html optimised.pvd; do [ -s "$run/$file" ] || fail "$file is missing"; done
expect 0 simulate "$quick" --quiet --set 'fem.mesh_size=34 mm' --set fem.time_scaling=20 --schedule "$run/schedule.json"
[ "$(lines "$run")" -lt "$total" ] || fail "it ran to its end"
expect 0 "${plan[@]}" --resume --out "$run"
same_end "$run" "an interrupt"

# Before the baselines are known there is nothing to write, and nothing is lost.
run=$work/early
"$program" "${plan[@]}" --threads 1 --set 'fem.mesh_size=12 mm' --out "$run" 2>"$work/stderr" &
job=$!
until [ -s "$run/evaluations.jsonl" ]; do sleep 0.02; done
kill -TERM $job
wait $job
same 3 $? "exit code of a plan that is interrupted early"
says "interrupted; --resume goes on"
[ ! -e "$run/schedule.json" ] || fail "there is a schedule"

# With a search over the rig before that over schedules.
design=(--set 'optimise.design=[{"path": "grippers.joint_offset", "from": "0 mm", "to": "4 mm"}]'
  --set optimise.design_evaluations=18 --set optimise.evaluations=15)
expect 0 "${plan[@]}" "${design[@]}" --out "$work/design"
total=$(lines "$work/design")
killed 2 "$work/killed-design" "${design[@]}"
same_file "$work/killed-design/design.json" "$work/design/design.json"
same "$(value "$work/design/result.json" /best/design)" "$(value "$work/killed-design/result.json" /best/design)" "design"
same_file "$work/killed-design/schedule.json" "$work/design/schedule.json"

refuse "--budget: a time" plan "$quick" --budget "10 mm"
refuse "--budget: a number of evaluations is 1 or more" plan "$quick" --budget 0
expect 0 "${plan[@]}" --budget "3 s" --out "$work/timed"
within "$work/timed/result.json" /evaluations 3 10000
within "$work/timed/result.json" /wall_seconds 0 30
finish 30
