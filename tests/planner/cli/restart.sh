#!/usr/bin/env bash
# simulate --pause, --save, --restart: the same bits as one run; states that do not fit are refused.
# Usage: restart.sh DRAPEPLAN SOURCE_DIR JSON_VALUE
set -uo pipefail
. "$(dirname "$0")/kit.sh"
hash_of() { value "$1" /state_hash; }
strip=$source/cases/cantilever-150.json
coarse=(--set 'duration=0.3 s' --set 'fem.mesh_size=10 mm')

# A drape with rig, mold and friction: paused in the preshape, and again in the drape.
expect 0 simulate "$quick" --json
cp "$work/stdout" "$work/whole.json"
expect 0 simulate "$quick" --json --pause '4 s' --save "$work/first.state"
same paused "$(value "$work/stdout" /status)" "status"
lacks "$work/stdout" /acceptance  # a run that goes on has no verdict yet
[ "$(hash_of "$work/stdout")" != "$(hash_of "$work/whole.json")" ] || fail "the pause did not pause"
expect 0 simulate "$quick" --json --restart "$work/first.state" --pause '7.3 s' --save "$work/second.state"
same paused "$(value "$work/stdout" /status)" "status"
expect 0 simulate "$quick" --json --restart "$work/second.state"
same done "$(value "$work/stdout" /status)" "status"
for key in state_hash steps score energy; do
  same "$(value "$work/whole.json" /$key)" "$(value "$work/stdout" /$key)" "$key after two pauses"
done
expect 0 simulate "$quick" --json --restart "$work/first.state" --threads 3
same "$(hash_of "$work/whole.json")" "$(hash_of "$work/stdout")" "three threads after a pause"

# Within the press.
press=(--fidelity screen --set 'press={"pressure": "30 kPa", "duration": "1 s", "ramp": "0.5 s", "pads": "released"}')
expect 0 simulate "$quick" --json "${press[@]}"
cp "$work/stdout" "$work/pressed.json"
value "$work/pressed.json" /score/rms_gap >"$work/value"
expect 0 simulate "$quick" --json "${press[@]}" --pause '11.7 s' --save "$work/press.state"
same paused "$(value "$work/stdout" /status)" "status"
expect 0 simulate "$quick" --json "${press[@]}" --restart "$work/press.state"
for key in state_hash steps score score_pressed energy; do
  same "$(value "$work/pressed.json" /$key)" "$(value "$work/stdout" /$key)" "$key after a pause in the press"
done

# A strip without a rig, with rates.
expect 0 simulate "$strip" --json "${coarse[@]}"
cp "$work/stdout" "$work/strip.json"
expect 0 simulate "$strip" --json "${coarse[@]}" --pause '0.1 s' --save "$work/strip.state"
expect 0 simulate "$strip" --json "${coarse[@]}" --restart "$work/strip.state"
for key in state_hash steps energy probes; do
  same "$(value "$work/strip.json" /$key)" "$(value "$work/stdout" /$key)" "$key of the strip"
done

# What is no state, or not one of this case.
state=$work/strip.state
again=(simulate "$strip" "${coarse[@]}" --restart)
head -c 1000 "$state" >"$work/cut.state"
refuse "$work/cut.state: is cut" "${again[@]}" "$work/cut.state"
{ head -c 2000 "$state"; printf '\377\001'; tail -c +2003 "$state"; } >"$work/flipped.state"
same "$(wc -c <"$state")" "$(wc -c <"$work/flipped.state")" "length of the damaged file"
refuse "$work/flipped.state: is damaged: its checksum does not fit" "${again[@]}" "$work/flipped.state"
: >"$work/empty.state"
refuse "$work/empty.state: is not a saved state" "${again[@]}" "$work/empty.state"
refuse "$work/none.state: cannot be read" "${again[@]}" "$work/none.state"
refuse "$work: cannot be read" "${again[@]}" "$work"
refuse "$work/first.state: was saved for another case, mesh or fidelity" "${again[@]}" "$work/first.state"
refuse "$state: was saved for another case, mesh or fidelity" simulate "$strip" --restart "$state" \
  "${coarse[@]}" --set 'fem.mesh_size=9 mm'
refuse "$state: was saved for another case, mesh or fidelity" simulate "$strip" --restart "$state" \
  "${coarse[@]}" --set 'material.rate_filter=0.1 s'
refuse "$work/first.state: was saved for another case, mesh or fidelity" simulate "$quick" --fidelity screen \
  --restart "$work/first.state"
cmp -s "$state" "$work/strip.state" || fail "a refused state was changed"

refuse '--pause: needs --save FILE' simulate "$strip" --pause '1 s'
refuse '--pause: must be > 0' simulate "$strip" --pause '0 s' --save "$work/x.state"
refuse '--pause: ' simulate "$strip" --pause '1 mm' --save "$work/x.state"
[ ! -e "$work/x.state" ] || fail "a state was saved by a wrong call"
# A place that cannot be written is named before the run.
expect 2 simulate "$strip" --quiet "${coarse[@]}" --pause '0.01 s' --save "$work/no/folder.state"
grep -qF "$work/no/folder.state" "$work/stderr" || fail "no path: $(cat "$work/stderr")"
finish 44
