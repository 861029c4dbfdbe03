#!/usr/bin/env bash
# VTK, which ParaView is built on, reads all collections that map, reach and simulate write: the same fields at all
# times. Exit status 77, which ctest calls skipped, where Python has no VTK.
# Usage: in_vtk.sh DRAPEPLAN SOURCE_DIR JSON_VALUE
set -uo pipefail
. "$(dirname "$0")/../cli/kit.sh"

python=
for one in python3 /usr/bin/python3; do
  "$one" -c 'import vtkmodules.vtkIOXML' 2>"$work/none" && python=$one && break
done
[ -n "$python" ] || { echo "SKIPPED: Python has no VTK (Debian: python3-vtk9), so nothing is read with it"; exit 77; }

expect 0 map "$quick" --quiet --out "$work/map"
expect 0 reach "$quick" --quiet --no-changes --out "$work/reach"
expect 0 simulate "$quick" --quiet --fidelity screen --frames 3 --out "$work/simulate"
"$python" "$(dirname "$0")/in_vtk.py" "$work"/{map,reach,simulate} >"$work/read" 2>"$work/faults" ||
  fail "$(head -c 1000 "$work/faults")"
reads() {  # reads TEXT: a line of what was read
  checks=$((checks + 1))
  grep -qxF -- "$1" "$work/read" || fail "not read: $1; but: $(cat "$work/read")"
}
grippers='gripper_i*1 gripper_j*1'
reads "net.pvd: 1 times, quad; points: u_m*1 v_m*1 ; cells: shear_deg*1"
reads "targets.pvd: 1 times, vertex; points: $grippers ; cells: "
reads "reachable.pvd: 1 times, line; points:  ; cells: $grippers distance_m*1"
reads "boundary.pvd: 1 times, polyline; points:  ; cells: "
reads "mold.pvd: 1 times, quad; points: normal*3 gaussian_curvature_per_m2*1 ; cells: "
reads "ply.pvd: 3 times, quad; points: gap_m*1 director*3 ; cells: shear_deg*1 warp_strain*1 weft_strain*1 fibre_angle_offset_deg*1"
reads "ply_grippers.pvd: 3 times, polygon; points:  ; cells: $grippers lag_m*3 actuator_force_N*1 suction*1"
reads "ply_interlinks.pvd: 3 times, line; points:  ; cells: length_m*1"
finish 11
