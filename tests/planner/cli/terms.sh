#!/usr/bin/env bash
# What a case does not have is in none of its outputs: terms, result.json, ParaView files. A drape has them all.
# Usage: terms.sh DRAPEPLAN SOURCE_DIR JSON_VALUE
set -uo pipefail
. "$(dirname "$0")/kit.sh"
strip=$source/cases/elastica.json
ladder=$source/tests/bench/ladder.json

has() {  # has FILE POINTER...
  local file=$1 pointer
  shift
  for pointer in "$@"; do within "$file" "$pointer"; done
}
arrays() { grep -o 'Name="[a-z_]*"' "$1" | grep -vE '"(points|connectivity|offsets|types)"' | tr '\n' ' '; }

# A strip with nothing but itself: the case without the sections that it has.
expect 0 simulate "$strip" --out "$work/bare" --frames 1 --set gravity=null --set damping=null --set supports=null \
  --set rest=null --set probes=null --set 'duration=5 ms'
same "terms: [shell, 3 section points]" "$(grep '^terms: ' "$work/stderr")" "terms on stderr"
bare=$work/bare/result.json
same '["shell, 3 section points"]' "$(value "$bare" /terms)" "terms of a bare strip"
has "$bare" /energy/kinetic /energy/internal /energy/hourglass /energy/balance_error /steps /dt /state_hash /status
lacks "$bare" /energy/external /energy/friction /energy/contact /energy/damping /energy/constraint \
  /largest_penetration /largest_link_error /probes /score
same 'Name="director" Name="shear_deg" Name="warp_strain" Name="weft_strain" ' "$(arrays "$work/bare/ply_000.vtu")" "arrays"
grep -qE 'friction|contact|damping|constraint|external' "$work/stdout" && fail "the summary tells of what is absent"

# Each section brings its own columns and no others.
expect 0 simulate "$strip" --json --set rest=null --set 'duration=5 ms'
cp "$work/stdout" "$work/strip.json"
has "$work/strip.json" /energy/external /energy/damping /probes/tip/displacement
lacks "$work/strip.json" /energy/friction /energy/contact /energy/constraint /largest_penetration /largest_link_error
expect 0 simulate "$source/cases/incline.json" --json --set friction=null --set 'duration=5 ms'
has "$work/stdout" /energy/contact /largest_penetration
lacks "$work/stdout" /energy/friction /energy/damping /energy/constraint /largest_link_error
expect 0 simulate "$source/cases/incline.json" --out "$work/incline" --frames 1 --set 'duration=5 ms'
has "$work/incline/result.json" /energy/contact /energy/friction
grep -q 'Name="gap_m"' "$work/incline/ply_000.vtu" || fail "no gap though there is a mold"

# All at once.
expect 0 simulate "$ladder" --out "$work/all" --frames 2 --set 'fem.mesh_size=20 mm' --set fem.fibre_mass_scaling=1.5 \
  --set 'schedule.preshape_duration=10 ms' --set 'schedule.uniform.duration=10 ms' --set 'schedule.settle=0 s'
all=$work/all/result.json
has "$all" /energy/{kinetic,internal,external,friction,contact,damping,constraint,hourglass,balance_error} \
  /largest_penetration /largest_link_error /score/max_actuator_force
lacks "$all" /probes
same "terms: [shell with rates, 5 section points] [gravity] [contact with friction] [fibre inertia] [mass damping] [gripper rig with interlinks] [fixed joint]" \
  "$(grep '^terms: ' "$work/stderr")" "terms of the whole ladder"
grep -q 'Name="gap_m"' "$work/all/ply_000.vtu" || fail "no gap in a drape"
# Without interlinks and a fixed joint there is no error of theirs, without damping nothing is damped.
expect 0 simulate "$ladder" --json --set 'fem.mesh_size=20 mm' --set fem.fibre_mass_scaling=1 --set fem.rates=false \
  --set grippers.interlinks=false --set grippers.fixed=null --set damping=null --set friction=null \
  --set 'schedule.preshape_duration=10 ms' --set 'schedule.uniform.duration=10 ms' --set 'schedule.settle=0 s'
has "$work/stdout" /energy/constraint /energy/contact
lacks "$work/stdout" /energy/damping /energy/friction /largest_link_error
grep -qF '[shell, 5 section points] [gravity] [contact] [gripper rig]' "$work/stderr" || fail "$(cat "$work/stderr")"
finish 60
