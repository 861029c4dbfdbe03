#!/usr/bin/env bash
# plan: the files of a run directory, the same result for every thread count, resume, wrong input.
# Usage: plan.sh DRAPEPLAN SOURCE_DIR JSON_VALUE
set -uo pipefail
. "$(dirname "$0")/kit.sh"

hash_of_best() { value "$1" /runs/best/state_hash; }
lines() { wc -l <"$1"; }

# One and two threads: the same search, the same best schedule.
expect 0 plan "$quick" --budget 20 --threads 2 --json --out "$work/two"
same_file "$work/stdout" "$work/two/result.json"
expect 0 plan "$quick" --budget 20 --threads 1 --quiet --out "$work/one"
[ ! -s "$work/stdout" ] && [ ! -s "$work/stderr" ] || fail "--quiet is not quiet: $(head -c 200 "$work/stdout" "$work/stderr")"
same_file "$work/one/schedule.json" "$work/two/schedule.json"
same_file "$work/one/schedule.csv" "$work/two/schedule.csv"
same_file "$work/one/resolved.json" "$work/two/resolved.json"
for run in uniform wave best; do
  same "$(value "$work/one/result.json" /runs/$run/state_hash)" "$(value "$work/two/result.json" /runs/$run/state_hash)" \
    "state hash of $run with one and two threads"
done
same "$(value "$work/one/result.json" /history)" "$(value "$work/two/result.json" /history)" "history"

# What a run directory holds, and what the result says.
for file in resolved.json result.json evaluations.jsonl schedule.json schedule.csv schedule_wide.csv schedule_ros2.yaml fibres.csv fibres.csv-metadata.json pattern.dxf drape.svg report.html mold.vtu \
  {uniform,wave,optimised}{,_grippers,_interlinks}.pvd {uniform,wave,optimised}{,_grippers,_interlinks}_{000,020}.vtu {mold,boundary}.pvd; do
  [ -s "$work/two/$file" ] || fail "plan: $file is missing or empty"
done
result=$work/two/result.json
for key in max_gap rms_gap wrinkled_area max_boundary_offset rms_boundary_offset max_shear_deg \
  max_fibre_strain max_actuator_force duration objective; do
  within "$result" "/baselines/uniform/$key" 0 1e6
  within "$result" "/baselines/wave/$key" 0 1e6
  within "$result" "/best/score/$key" 0 1e6
done
same schedule.json "$(value "$result" /best/schedule)" "the best schedule's file"
best=$(value "$result" /best/score/objective)
within "$result" /baselines/uniform/objective "$best" 1e6   # the best is at least as good as both
within "$result" /baselines/wave/objective "$best" 1e6
within "$result" /evaluations 10 1000
within "$result" /failed_evaluations 0 0
within "$result" /wall_seconds 0 1e6
for key in evaluation fidelity objective best_so_far; do within "$result" "/history/0/$key"; done
for run in uniform wave best; do within "$result" "/runs/$run/energy/balance_error" 0 1e-6; done
head -1 "$work/two/schedule.csv" | grep -qx 'gripper_i,gripper_j,time_s,z_m,vz_m_per_s' || fail "schedule.csv: header"
grep -q '<svg' "$work/two/report.html" || fail "report.html has no picture"
! grep -qE '(src|href)="(https?:)?//' "$work/two/report.html" || fail "report.html needs the network"

# The exported schedule, in the case with all defaults, is the best run.
for case in "$quick" "$work/two/resolved.json"; do
  expect 0 simulate "$case" --json --schedule "$work/two/schedule.json"
  same "$(hash_of_best "$result")" "$(value "$work/stdout" /state_hash)" "best schedule again in $case"
  expect 0 simulate "$case" --json
  same "$(value "$result" /runs/uniform/state_hash)" "$(value "$work/stdout" /state_hash)" "uniform again in $case"
done

# Killed half-way, in the middle of a line: the lost evaluations run again, the others do not.
log=$work/two/evaluations.jsonl
whole=$(lines "$log")
kept=$((whole / 2))
mkdir "$work/cut"
{ head -n "$kept" "$log"; sed -n "$((kept + 1))p" "$log" | head -c 100; } >"$work/cut/evaluations.jsonl"
expect 0 plan "$quick" --budget 20 --resume --quiet --out "$work/cut"
same_file "$work/cut/schedule.json" "$work/two/schedule.json"
same "$(hash_of_best "$work/cut/result.json")" "$(hash_of_best "$result")" "best after resuming"
same "$(lines "$work/cut/evaluations.jsonl")" "$whole" "lines after resuming"
same "$(head -n "$kept" "$work/cut/evaluations.jsonl" | cksum)" "$(head -n "$kept" "$log" | cksum)" "lines that were kept"

# A finished run is served from its log; without --resume a run starts anew.
cp "$log" "$work/log"
expect 0 plan "$quick" --budget 20 --resume --quiet --out "$work/two"
same_file "$log" "$work/log"

# The log of another case is refused and stays as it was, and so do the other files.
cp "$work/two/result.json" "$work/result"
expect 2 plan "$quick" --resume --out "$work/two" --set 'friction.coefficient=1.4'
grep -qF "evaluations.jsonl: belongs to another case" "$work/stderr" || fail "no reason: $(cat "$work/stderr")"
same_file "$log" "$work/log"
same_file "$work/two/result.json" "$work/result"
# --json is one document then, too: it names the case and the reason.
expect 2 plan "$quick" --resume --json --out "$work/two" --set 'friction.coefficient=1.4'
value "$work/stdout" /reason | grep -qF "belongs to another case" || fail "no reason in the document"

# Several cases in one call: a folder each, one document. Small budgets: what counts is the number of cases.
few=(--set optimise.evaluations=2 --set optimise.finalists=1)
sed "s#\"materials/#\"$source/cases/materials/#" "$quick" >"$work/second.json"
expect 0 plan "$quick" "$work/second.json" --json --out "$work/several" "${few[@]}"
same "$(hash_of_best "$work/several/flexdraper-quick/result.json")" "$(hash_of_best "$work/several/second/result.json")" \
  "the same case twice in one call"
within "$work/stdout" /cases/1/best/score/objective 0 1e6
# Three threads, more than a machine may have cores: the same again.
expect 0 plan "$quick" --threads 3 --quiet --out "$work/three" "${few[@]}"
same "$(hash_of_best "$work/several/flexdraper-quick/result.json")" "$(hash_of_best "$work/three/result.json")" \
  "state hash of the best with three threads"
same "$(value "$work/several/flexdraper-quick/result.json" /history)" "$(value "$work/three/result.json" /history)" \
  "history with three threads"
# Two files of one name would share a folder.
mkdir "$work/twin" && cp "$work/second.json" "$work/twin/"
refuse 'second.json' plan "$work/second.json" "$work/twin/second.json" "${few[@]}"

refuse 'needs the section "grippers"' plan "$source/cases/elastica.json"
# One that is wrong stops no other one: it is named, and the summary has both.
expect 2 plan "$source/cases/elastica.json" "$quick" --out "$work/batch" "${few[@]}"
grep -qF 'needs the section "grippers"' "$work/stderr" || fail "the wrong case is not named"
grep -q 'of 2 drapes are accepted, 1 wrong input' "$work/stdout" || fail "no summary: $(tail -5 "$work/stdout")"
same "$(cut -d, -f3 "$work/batch/summary.csv" | tr '\n' ' ')" 'status wrong input not accepted ' "summary.csv"
grep -qF 'href="./flexdraper-quick/report.html"' "$work/batch/summary.html" || fail "summary.html leads nowhere"
expect 2 plan "$quick" "$source/cases/elastica.json" --json --out "$work/batch" "${few[@]}" --resume
same "$(value "$work/stdout" /cases/1/status)" 'wrong input' "status of a wrong case"
refuse '/grippers/spacing: "150 mm": gripper [3, 3] is off the ply' plan "$quick" --set 'grippers.spacing=150 mm'
refuse '/material/thickness: "-1 mm": out of range' plan "$quick" --set 'material.thickness=-1 mm'
refuse '/ply/widht: unknown key' plan "$quick" --set 'ply.widht=1 mm'
refuse "$work/none.json" plan "$work/none.json"
finish 83
