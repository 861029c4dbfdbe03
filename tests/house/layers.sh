#!/usr/bin/env bash
# The house rules that a compiler does not check: which way includes run, who may touch which library, how large a room
# is, what lies at the top level. Usage: layers.sh SOURCE_DIR
set -uo pipefail
cd "$1" || exit 1

# All rooms, from the ground up: a source may include what lies in its own room and in those before it.
rooms=(mapping/surface mapping
  fem/{core,mesh,law,shell,rig,terms,model,run}
  planner/{base,input,tables,molds,case,score,reach,schedule,drape,stress,method,search,trust,diagnosis,page,exports,report,batch,views,replay,study,measured,characterise,validate,cli,verbs,program})
least_files=4 most_files=15

failures=0
fail() { echo "FAILED: $*" >&2; failures=$((failures + 1)); }
include='^[[:space:]]*#[[:space:]]*include[[:space:]]*'
mapfile -t sources < <(find mapping fem planner -name '*.[ch]pp' | sort)
[ ${#sources[@]} -ge 100 ] || fail "sources not found below $PWD"

for source in "${sources[@]}"; do
  [[ " ${rooms[*]} " == *" $(dirname "$source") "* ]] || fail "$source lies in no room"
done
below=""
for room in "${rooms[@]}"; do
  files=("$room"/*.[ch]pp)
  [ ${#files[@]} -ge $least_files ] && [ ${#files[@]} -le $most_files ] ||
    fail "$room has ${#files[@]} files; a room has $least_files to $most_files"
  below+=" $room "
  while IFS=: read -r file line path; do
    [[ $below == *" $(dirname "$path") "* ]] || fail "$file:$line: $room lies below, or beside, what it includes: $path"
  done < <(grep -nHoE "${include}\"[^\"]+\"" "${files[@]}" | sed -E 's/#.*"([^"]+)"/\1/')
done

# only_in ROOM REASON PATTERN: lines that match lie in this room alone.
only_in() {
  local found
  found=$(grep -nE -- "$3" "${sources[@]}" | grep -v "^$1/")
  [ -z "$found" ] || fail "$2:"$'\n'"$found"
}
# in_one_file REASON PATTERN: one file has all lines that match, and there are some.
in_one_file() {
  local found
  found=$(grep -lE -- "$2" "${sources[@]}")
  [ "$(wc -w <<<"$found")" = 1 ] || fail "$1: ${found:-nowhere}"
}
only_in planner "JSON is for planner's input and results" "${include}<nlohmann/"
only_in planner/reach "Ipopt is for the reach problem" "${include}[<\"](coin/)?Ip[A-Z]"
in_one_file "threads live in one file" "${include}<omp\.h>|^[[:space:]]*#[[:space:]]*pragma[[:space:]]+omp"
in_one_file "VTK files are written in one file" "<VTKFile"
in_one_file "Assimp stays behind one source" "${include}<assimp/Importer"
in_one_file "NLopt stays behind one source" "${include}<nlopt"

allowed=" CMakeLists.txt CMakePresets.json LICENSE README.md cases fem mapping planner scripts tests "
# The tree may belong to another user than the one who tests: git would refuse it.
tree=(git -c "safe.directory=*")
if "${tree[@]}" rev-parse --is-inside-work-tree >/dev/null 2>&1; then
  while IFS= read -r entry; do
    [[ $entry == .* || $allowed == *" $entry "* ]] || fail "'$entry' does not belong at the top level"
  done < <("${tree[@]}" ls-files | cut -d/ -f1 | sort -u)
fi
[ $failures = 0 ]
