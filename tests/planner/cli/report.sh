#!/usr/bin/env bash
# report: the page of a run made again from its files is the same page, and nothing else of the run is touched; what is
# missing, wrong, changed or not ended is named.
# Usage: report.sh DRAPEPLAN SOURCE_DIR JSON_VALUE
set -uo pipefail
. "$(dirname "$0")/kit.sh"
coarse=(--set 'fem.mesh_size=40 mm' --set fem.time_scaling=30 --set 'fidelities={}' --set optimise.finalists=1)
all_files() { (cd "$1" && find . -type f ! -name run.lock -exec cksum {} + | sort -k 3); }

# same_page NAME RUN DRAPES: the files of people are removed, but for the page, which is made wrong: all come back.
same_page() {
  local before run=$2 k
  before=$(all_files "$run")
  find "$run" -maxdepth 1 \( -name '*.svg' -o -name '*.vtu' -o -name '*.pvd' \) -delete
  echo "an old page" >"$run/report.html"
  expect 0 report "$run" --json
  same "$before" "$(all_files "$run")" "$1: files"
  same "$run/report.html" "$(value "$work/stdout" /report | tr -d '"')" "$1: the page"
  for ((k = 0; k < $3; ++k)); do same true "$(value "$work/stdout" "/drapes/$k/same")" "$1: drape $k"; done
  lacks "$work/stdout" "/drapes/$3" /warnings/0
  [ ! -s "$work/stderr" ] || fail "$1: something on stderr: $(head -c 400 "$work/stderr")"
}

plan=$work/plan
expect 0 plan "$quick" "${coarse[@]}" --budget 8 --quiet --out "$plan"
for key in /confirmation /robust /diagnosis/effects/0; do within "$plan/result.json" "$key"; done
same_page plan "$plan" 3
expect 0 plan "$quick" "${coarse[@]}" --budget 6 --quiet --out "$work/design" --set 'press={"pressure": "30 kPa"}' \
  --set 'optimise.design=[{"path": "grippers.joint_offset", "from": "0 mm", "to": "3 mm"}]' --set optimise.design_evaluations=4
within "$work/design/result.json" /best/design/changes/0/path
within "$work/design/result.json" /best/score_pressed/objective
same_page "plan of a rig" "$work/design" 3
watch=(--set 'probes=[{"name": "corner", "place": ["100 mm", "100 mm"]}]' --set 'instants=[{"name": "preshape", "time": "5 s"}]'
  --set 'profiles=[{"name": "mid", "from": ["225 mm", "100 mm"], "to": ["225 mm", "350 mm"]}]')
drape=$work/drape
expect 0 simulate "$quick" --fidelity screen --schedule wave --frames 5 "${watch[@]}" --quiet --out "$drape"
same_page simulate "$drape" 1
expect 0 simulate "$quick" --fidelity screen --schedule "$drape/schedule.csv" --frames 2 --quiet --out "$work/logged"
same_page "a motion as a table" "$work/logged" 1
expect 0 simulate "$source/cases/bias-extension.json" --set 'duration=5 s' --quiet --out "$work/strip"
same_page "a strip" "$work/strip" 1

# Killed before it has written its page: the old one is there, and the next call makes it.
before=$(all_files "$plan")
"$program" report "$plan" --quiet &
job=$!
{ kill -9 $job && wait $job; } 2>/dev/null
same "$(cksum <"$plan/report.html")" "$(grep ' ./report.html$' <<<"$before" | cut -d' ' -f1,2)" "the page after a kill"
expect 0 report "$plan" --quiet
[ ! -s "$work/stdout" ] && [ ! -s "$work/stderr" ] || fail "--quiet is not quiet"
same "$before" "$(all_files "$plan")" "files after a kill"

# A run whose files say something else than its replay: a page all the same, with a warning.
cp -r "$drape" "$work/other"
sed -i 's/"state_hash": "[0-9a-f]*"/"state_hash": "0123456789abcdef"/' "$work/other/result.json"
kept=$(cksum <"$work/other/result.json")
expect 0 report "$work/other" --json
says "warning: replay differs: wave: state "
says "instead of 0123456789abcdef as recorded"
same false "$(value "$work/stdout" /drapes/0/same)" "a changed hash"
same "$kept" "$(cksum <"$work/other/result.json")" "result.json"
checks=$((checks + 1))
grep -qF 'replay differs' "$work/other/report.html" || fail "the page does not say that its replay differs"
cp -r "$drape" "$work/weights"
sed -i "/\"weights\": {/,/}/ s/\"max_gap\": [0-9.]*/\"max_gap\": 3.5/" "$work/weights/resolved.json"
cmp -s "$drape/resolved.json" "$work/weights/resolved.json" && fail "no weight was changed"
expect 0 report "$work/weights" --json
says "the same state has another score, objective"

# refused CODE TEXT FOLDER [OPTIONS]: with the reason, and all files stay.
refused() {
  local code=$1 text=$2 folder=$3 before
  before=$(all_files "$folder" 2>/dev/null)
  shift 3
  expect "$code" report "$folder" "$@"
  says "$text"
  [ ! -s "$work/stdout" ] || fail "something on stdout: $text"
  [ "$before" = "$(all_files "$folder" 2>/dev/null)" ] || fail "files have changed: $text"
}
# without FILE CODE TEXT RUN: a copy of the run that lacks this file.
without() {
  rm -rf "$work/copy" && cp -r "$4" "$work/copy" && rm "$work/copy/$1"
  refused "$2" "$3" "$work/copy"
}
refused 2 "there is no such folder" "$work/nowhere"
[ ! -e "$work/nowhere" ] || fail "a folder was made"
refused 2 "is no folder" "$quick"
mkdir "$work/empty" && refused 2 "is not the folder of a run" "$work/empty"
without run.lock 2 "is not the folder of a run: there is no run.lock" "$plan"
without result.json 3 "--resume" "$plan"
without result.json 3 "its run has not ended" "$drape"
without schedule.json 2 "schedule.json" "$plan"
without schedule_wave.json 2 "schedule_wave.json" "$plan"
without resolved.json 2 "resolved.json" "$drape"
without design.json 2 "design.json" "$work/design"
rm -rf "$work/copy" && cp -r "$plan" "$work/copy" && echo '{"best": 3}' >"$work/copy/result.json"
refused 2 "result.json: is not what \`plan\` of this version writes" "$work/copy"
echo '{"best":' >"$work/copy/result.json"
refused 2 "result.json" "$work/copy"
rm -rf "$work/copy" && cp -r "$drape" "$work/copy" && rm "$work/copy/schedule.json" && mkfifo "$work/copy/schedule.json"
expect 2 report "$work/copy"   # a pipe may never end
says "schedule.json: is no file that a run has written"
expect 0 map "$quick" --quiet --out "$work/map"
refused 2 "holds results of \`map\`; \`report\` makes the pages of \`plan\` and \`simulate\` again" "$work/map"
expect 0 simulate "$quick" --fidelity screen --pause '2 s' --save "$work/half" --frames 2 --quiet --out "$work/part"
refused 2 "is one part of a run (--pause, --restart)" "$work/part"
refused 2 "--out: the page lies beside" "$plan" --out "$work/elsewhere"
[ ! -e "$work/elsewhere" ] || fail "--out was made"
refused 2 "--set, --seed: the page is of the run as it was" "$plan" --set 'score.target_gap=2 mm'
exec 9<>"$plan/run.lock" && flock 9
refused 2 "another run works in this folder" "$plan"
exec 9>&-

finish 91
