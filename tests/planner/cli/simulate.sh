#!/usr/bin/env bash
# simulate: its document, same bits twice, cases with and without grippers, wrong input.
# Usage: simulate.sh DRAPEPLAN SOURCE_DIR JSON_VALUE
set -uo pipefail
. "$(dirname "$0")/kit.sh"

# The document that scripts rely on.
expect 0 simulate "$quick" --json --fidelity screen
cp "$work/stdout" "$work/first.json"
for key in element_updates_per_second wall_seconds state_hash status; do
  within "$work/first.json" "/$key"
done
for key in kinetic internal external friction damping hourglass constraint; do
  within "$work/first.json" "/energy/$key" -1e3 1e3
done
for key in max_gap rms_gap wrinkled_area max_boundary_offset rms_boundary_offset max_shear_deg \
  max_fibre_strain max_actuator_force duration objective; do
  within "$work/first.json" "/score/$key" 0 1e6
done
within "$work/first.json" /energy/balance_error 0 1e-6
within "$work/first.json" /energy/external 1e-3 10   # work was done at all
within "$work/first.json" /steps 1000 1e9
within "$work/first.json" /dt 1e-9 1e-2

# Same bits again, and from the case with all defaults filled in.
expect 0 simulate "$quick" --json --fidelity screen --out "$work/out" --frames 2
same "$(value "$work/first.json" /state_hash)" "$(value "$work/stdout" /state_hash)" "two runs"
same_file "$work/stdout" "$work/out/result.json"
for file in resolved.json schedule.json schedule.csv schedule.csv-metadata.json schedule_wide.csv schedule_ros2.yaml fibres.csv fibres.csv-metadata.json ply.pvd ply_000.vtu ply_001.vtu mold.vtu drape.svg; do
  [ -s "$work/out/$file" ] || fail "simulate: $file is missing or empty"
done
expect 0 simulate "$work/out/resolved.json" --json --fidelity screen
same "$(value "$work/first.json" /state_hash)" "$(value "$work/stdout" /state_hash)" "resolved case"
expect 0 simulate "$quick" --json --fidelity screen --schedule "$work/out/schedule.json"
same "$(value "$work/first.json" /state_hash)" "$(value "$work/stdout" /state_hash)" "schedule read from its file"

# The motion read back from the files for a robot gives the same drape: gaps of this case move by 0.04 mm when knots
# move by 2 um, which is what reading back is known to.
expect 0 simulate "$quick" --quiet --fidelity screen --out "$work/fine" --cycle '4 ms' --frames 2
same "$(sed -n 3p "$work/fine/schedule.csv" | cut -d, -f3)" 0.004 "second row with --cycle"
grep -q '^# case: flexdraper-quick, hash [0-9a-f]\{16\}$' "$work/fine/schedule_wide.csv" || fail "no case in the head"
for file in schedule.csv schedule_wide.csv; do
  expect 0 simulate "$quick" --json --fidelity screen --schedule "$work/fine/$file" --out "$work/again" --frames 2
  for part in max_gap rms_gap max_boundary_offset; do
    near=$(value "$work/first.json" "/score/$part")
    within "$work/stdout" "/score/$part" $(awk -v v="$near" 'BEGIN {print v - 1e-4, v + 1e-4}')
  done
  [ -s "$work/again/schedule_ros2.yaml" ] || fail "$file: no trajectory of a motion that was read"
done
refuse '--cycle: "mm" is the unit of a length' simulate "$quick" --cycle '5 mm'
refuse '--cycle: "2 s": out of range; allowed: whole microseconds from 0.1 ms to 100 ms' simulate "$quick" --cycle '2 s'
refuse '--cycle' plan "$quick" --cycle 4
# Logs that are wrong: each error with its line, and what the rig cannot follow.
log=$work/log.csv
sed '5s/.*/1,1,0.001,0.1,0/; 7s/,[^,]*$/,nan/' "$work/fine/schedule.csv" >"$log"
refuse "$log:5: time_s: 0.001: times must increase; [1, 1] was at 0.008 before" simulate "$quick" --schedule "$log"
refuse "$log:7: vz_m_per_s: \"nan\" is no finite number" simulate "$quick" --schedule "$log"
grep -v '^3,3,' "$work/fine/schedule.csv" >"$log"
refuse "$log:1: no row for gripper [3, 3]" simulate "$quick" --schedule "$log"
refuse 'moves at up to' simulate "$quick" --schedule "$work/fine/schedule.csv" --set 'grippers.max_velocity=5 mm/s'

# A drape that leaves what a curve is known to hold for says so, and moves as before; shipped materials are stable.
value "$work/first.json" /warnings | grep -qF 'beyond what material' && fail "a warning of what was not reached"
# Checks of a run are named; the quick case is coarse, and its outer pads are half beyond the ply.
for check in kinetic overhang; do
  value "$work/first.json" /warnings | grep -qF "$check:" || fail "no warning \"$check\""
done
expect 3 simulate "$quick" --set score.kinetic_limit=1
grep -qF 'thrown' "$work/stdout" "$work/stderr" || fail "a thrown ply is not marked"
# The page says it, too, and at which fidelity, and what the robot's operator must know.
expect 0 simulate "$quick" --fidelity screen --frames 2 --quiet --out "$work/paged"
for words in '<li>kinetic: ' '<li>overhang: ' '<td>fidelity</td><td>screen</td>' '<h2>For the robot</h2>'; do
  checks=$((checks + 1))
  grep -qF "$words" "$work/paged/report.html" || fail "the page lacks $words"
done
expect 0 simulate "$quick" --json --fidelity screen --set material.shear.valid_to='1 deg'
value "$work/stdout" /warnings/0 | grep -qF 'beyond what material.shear holds for (1.0 deg)' || fail "no warning"
grep -qF 'warning: the largest shear is' "$work/stderr" || fail "no warning on stderr"
same "$(value "$work/first.json" /state_hash)" "$(value "$work/stdout" /state_hash)" "with valid_to"
for material in "$source"/cases/materials/*.json; do
  expect 0 simulate "$quick" --json --fidelity screen --set material="materials/$(basename "$material")"
  within "$work/stdout" /energy/balance_error 0 1e-6
done

# Another schedule is another run: the hash does see the motion.
expect 0 simulate "$quick" --json --fidelity screen --schedule wave
[ "$(value "$work/first.json" /state_hash)" != "$(value "$work/stdout" /state_hash)" ] || fail "wave equals uniform"

expect 0 simulate "$quick" --fidelity screen --quiet
[ ! -s "$work/stdout" ] && [ ! -s "$work/stderr" ] || fail "--quiet is not quiet"

# The heavy elastica at rest: exact tip drop 88.2175 mm (w L^3 / (E I) = 6.695 for this strip, shooting).
# Damping alpha = 22 / s is twice the first angular frequency, sqrt(12.36 E I / (m L^4)) = 11 / s, so what moves decays
# as (1 + 11 t / s) exp(-11 t / s): after 1 s 2e-4 of the drop is left. Scaling the mass by 4 doubles all times: 2 s.
expect 0 simulate "$source/cases/elastica.json" --json --set 'fem.mesh_size=7.5 mm' --set fem.mass_scaling=4 \
  --set 'duration=2 s'
within "$work/stdout" /probes/tip/displacement/2 -0.0886586 -0.0877764   # 0.5 %
within "$work/stdout" /probes/tip/displacement/1 -1e-6 1e-6              # stays in its plane
within "$work/stdout" /energy/kinetic 0 1e-9                             # J; 0.4 mJ of work were done: at rest
within "$work/stdout" /energy/balance_error 0 1e-6

# Coulomb friction on an incline, mu = 0.7, atan(0.7) = 34.99 deg: sticks below without creep, slides above by
# g (sin - mu cos) t^2 / 2 = 20.9064 mm in 0.2 s at 40 deg, of which 16.0152 mm along x.
incline=$source/cases/incline.json
for angle in 30 34.9; do
  for duration in 0.1 0.3; do
    expect 0 simulate "$incline" --json --set "mold.angle=$angle deg" --set "duration=$duration s"
    for axis in 0 2; do
      within "$work/stdout" /probes/tip/displacement/$axis -1e-8 1e-8
      value "$work/stdout" /probes/tip/displacement/$axis >"$work/at_$duration.$axis"
    done
  done
  for axis in 0 2; do
    checks=$((checks + 1))
    paste "$work/at_0.1.$axis" "$work/at_0.3.$axis" | awk '{d = $1 - $2; exit !(NF == 2 && d <= 1e-9 && d >= -1e-9)}' ||
      fail "incline: creeps at $angle deg: $(cat "$work/at_0.1.$axis" "$work/at_0.3.$axis")"
  done
done
expect 0 simulate "$incline" --json --set 'mold.angle=40 deg' --set 'duration=0.2 s'
within "$work/stdout" /probes/tip/displacement/0 0.0159992 0.0160312   # 0.1 %
within "$work/stdout" /probes/tip/displacement/1 -1e-9 1e-9
within "$work/stdout" /energy/friction 5.47e-5 5.58e-5                 # J: mu m g cos 40 deg times the path

refuse '/fidelities: there is no fidelity "finest"' simulate "$quick" --fidelity finest
refuse "$work/none.json" simulate "$quick" --schedule "$work/none.json"
refuse '/ply/widht: unknown key' simulate "$quick" --set 'ply.widht=1 mm'
refuse '/fem/mesh_size: "-1 mm": out of range' simulate "$quick" --set 'fem.mesh_size=-1 mm'
refuse 'needs the section "material"' simulate "$source/cases/plane-mapping.json"
# A schedule of another rig: one gripper of nine is not there.
sed 's/"gripper": \[3, 3\]/"gripper": [4, 3]/' "$work/out/schedule.json" >"$work/other.json"
cmp -s "$work/out/schedule.json" "$work/other.json" && fail "the schedule file was not changed"
refuse "$work/other.json" simulate "$quick" --schedule "$work/other.json"
echo '{"format": "drapeplan-schedule 1", "blend_time": 0.1, "grippers": []}' >"$work/empty.json"
refuse "$work/empty.json" simulate "$quick" --schedule "$work/empty.json"
# A place that cannot be written is named before the run.
touch "$work/file"
expect 2 simulate "$quick" --fidelity screen --quiet --out "$work/file/below"
grep -qF "$work/file/below" "$work/stderr" || fail "no path: $(cat "$work/stderr")"
finish 80
