#!/usr/bin/env bash
# study and stress: what their documents hold, what a resumed study does again, wrong input.
# Usage: study.sh DRAPEPLAN SOURCE_DIR JSON_VALUE
set -uo pipefail
# shellcheck source=tests/planner/cli/kit.sh
source "$(dirname "$0")/kit.sh" "$@"
strip=$source/cases/cantilever-150.json
short=(--set "duration=0.01 s" --set "fem.mesh_size=25 mm" --repeats 1)

expect 0 study "$strip" "${short[@]}" --out "$work/study" --json
cp "$work/stdout" "$work/first"
same "$(value "$work/first" /case)" cantilever-150 "name of the case"
within "$work/first" /reference/runs/0/wall_seconds 0 100
within "$work/first" /points/0/error/relative 0 1
within "$work/first" /points/0/element_updates 1 1e9
within "$work/first" /points/0/cpu_seconds 0 100
value "$work/first" /points/0/settings/fem.mesh_size >"$work/value"
value "$work/first" /fidelities >"$work/value"
for file in study.md points.csv work_precision_relative.svg work_precision_places.svg knobs.svg study.jsonl resolved.json; do
  checks=$((checks + 1))
  [ -s "$work/study/$file" ] || fail "study wrote no $file"
done
runs=$(wc -l <"$work/study/study.jsonl")
expect 0 study "$strip" "${short[@]}" --out "$work/study" --resume --json
same "$(wc -l <"$work/study/study.jsonl")" "$runs" "runs after a study that was resumed when it was done"
same_file "$work/first" "$work/stdout"

refuse "unknown" study "$strip" --set "fem.mesh_seize=3 mm"
refuse "--part" study "$strip" --part everything
refuse "no-such" study "$source/cases/no-such.json"
refuse "material" study "$source/cases/plane-mapping.json"
refuse "no section \"grippers\"" study "$strip" --part ranks
refuse "duration" study "$strip" --set "duration=0 s"
refuse "probes" study "$strip" --set "probes=[]"
refuse "evaluations.jsonl" study "$quick" --part search --run "$source"
expect 2 study "$strip" "${short[@]}" --out "$strip/below"
echo 'no run' >"$work/study/study.jsonl"
echo 'nor this' >>"$work/study/study.jsonl"
expect 2 study "$strip" "${short[@]}" --out "$work/study" --resume
grep -q 'study.jsonl:1' "$work/stderr" || fail "the broken line is not named: $(head -c 300 "$work/stderr")"

# A drape: ranks and the search of a run.
coarse=(--set "fem.mesh_size=34 mm" --set "fidelities={}" --set fem.time_scaling=30 --set optimise.evaluations=8
  --set optimise.finalists=1)
expect 0 study "$quick" "${coarse[@]}" --part search --part noise --part reach --part mapping --schedules 4 --repeats 1 \
  --out "$work/drape" --json
within "$work/stdout" /searches/0/best/0 0 1000
within "$work/stdout" /noise/0/objective 0 1000
within "$work/stdout" /reach/0/link_violation 0 1e-6
within "$work/stdout" /mapping/1/error/places 0 1e-3

refuse "no scene" stress --only "no such scene"
refuse "--set" stress --set fem.rates=false

expect 0 stress --only "size: two elements" --only "friction: 30 deg, coefficient 0.5" --out "$work/stress" --json
same "$(value "$work/stdout" /scenes/0/verdict)" right "verdict on two elements"
within "$work/stdout" /scenes/1/balance_error 0 1e-9
within "$work/stdout" /scenes/0/true_over_estimated_step 0.9 2
same "$(value "$work/stdout" /failures)" "[]" "scenes that failed"
for file in stress.md stress.csv; do
  checks=$((checks + 1))
  [ -s "$work/stress/$file" ] || fail "stress wrote no $file"
done
finish 40
