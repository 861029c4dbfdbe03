#!/usr/bin/env bash
# What simulate shows: histories of probes and grips, profiles, views, and the page; also of a run in two parts.
# Usage: views.sh DRAPEPLAN SOURCE_DIR JSON_VALUE
set -uo pipefail
. "$(dirname "$0")/kit.sh"

header() { head -n 1 "$1"; }
# last FILE COLUMN: of the last row.
last() {
  awk -F, -v name="$2" 'NR == 1 {for (k = 1; k <= NF; ++k) if ($k == name) c = k; next} {v = $c} END {if (c) print v}' "$1"
}
# near A B SHARE: A is B within a share of it.
near() {
  checks=$((checks + 1))
  awk -v a="$1" -v b="$2" -v s="$3" 'BEGIN {d = a - b; if (d < 0) d = -d; m = b < 0 ? -b : b; exit !(a != "" && d <= s * m)}' ||
    fail "$4: $1 instead of $2"
}
has_files() {
  local folder=$1 file
  shift
  for file in "$@"; do
    checks=$((checks + 1))
    [ -s "$folder/$file" ] || fail "$folder: $file is missing or empty"
  done
}

# Force over displacement of the bias extension: what the test machine would see.
expect 0 simulate "$source/cases/bias-extension.json" --json --out "$work/bias" --frames 2
has_files "$work/bias" grips.csv grips.svg probes.csv probes.svg shear.svg report.html result.json
same "$(wc -l <"$work/bias/grips.csv")" 202 "rows of grips.csv"
near "$(last "$work/bias/grips.csv" 'head displacement y [mm]')" 40 1e-6 "way of the head"
near "$(last "$work/bias/grips.csv" 'time [s]')" 250 1e-6 "time"
near "$(last "$work/bias/grips.csv" 'simulated time [s]')" 1 1e-6 "simulated time"
force=$(value "$work/stdout" /probes/head/force/1)
near "$(last "$work/bias/grips.csv" 'head force y [N]')" "$force" 1e-6 "force of the head"
near "$force" 16.40 0.01 "force of the head at 40 mm"
within "$work/bias/result.json" /probes/head/force/1 "$force" "$force"
checks=$((checks + 1))
grep -qF 'Force of the grips' "$work/bias/report.html" || fail "the page has no chart of forces"

# A drape: probes with their gap, a profile at an instant and at the end; the same bits as without files.
watch=(--fidelity screen --set 'probes=[{"name": "corner", "place": ["100 mm", "100 mm"]}]'
       --set 'profiles=[{"name": "mid", "from": ["225 mm", "100 mm"], "to": ["225 mm", "350 mm"]}]'
       --set 'instants=[{"name": "preshape", "time": "5 s"}, {"name": "later", "time": "99 s"}]')
expect 0 simulate "$quick" --json "${watch[@]}"
cp "$work/stdout" "$work/unseen.json"
expect 0 simulate "$quick" --json "${watch[@]}" --out "$work/drape" --frames 2
same "$(value "$work/unseen.json" /state_hash)" "$(value "$work/stdout" /state_hash)" "a run that is looked at"
same "$(value "$work/unseen.json" /probes)" "$(value "$work/stdout" /probes)" "its probes"
has_files "$work/drape" probes.csv profile_mid.csv profile_mid.svg profile_mid_heights.svg shear.svg drape.svg report.html
same "$(header "$work/drape/probes.csv")" "time [s],simulated time [s],corner x [mm],corner y [mm],corner z [mm],\
corner displacement x [mm],corner displacement y [mm],corner displacement z [mm],corner drop [mm],corner gap [mm]" "header"
same "$(header "$work/drape/profile_mid.csv")" "time [s],along [mm],x [mm],y [mm],ply [mm],mold [mm],gap [mm]" "header"
same "$(tail -n +2 "$work/drape/profile_mid.csv" | cut -d, -f1 | sort -u | wc -l)" 2 "instants of the profile"
checks=$((checks + 1))
awk -F, 'NR > 1 && ($3 < 224.999 || $3 > 225.001 || $7 > 60 || $7 < -0.3) {exit 1}' "$work/drape/profile_mid.csv" ||
  fail "profile_mid.csv leaves its line, or the mold"

# A run in two parts shows each its own part; together they are the whole.
expect 0 simulate "$quick" --json "${watch[@]}" --pause '6 s' --save "$work/half.state" --out "$work/first" --frames 2
expect 0 simulate "$quick" --json "${watch[@]}" --restart "$work/half.state" --out "$work/second" --frames 2
{ head -n -1 "$work/first/probes.csv"; tail -n +2 "$work/second/probes.csv"; } >"$work/joined.csv"
same_file "$work/joined.csv" "$work/drape/probes.csv"
same "$(tail -n +2 "$work/second/profile_mid.csv" | cut -d, -f1 | sort -u | wc -l)" 1 "instants after the restart"

# What an earlier run left is set aside.
expect 0 simulate "$source/cases/incline.json" --json --set 'duration=0.01 s' --out "$work/drape" --frames 1
has_files "$work/drape/earlier-1" probes.csv profile_mid.csv report.html
[ ! -e "$work/drape/profile_mid.csv" ] || fail "a profile of an earlier run is left"

finish 39
