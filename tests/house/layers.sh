#!/usr/bin/env bash
# The house rules that a compiler does not check: which way includes run, who may touch which library, what lies at the
# top level. Usage: layers.sh SOURCE_DIR
set -uo pipefail
cd "$1" || exit 1
failures=0
fail() { echo "FAILED: $*" >&2; failures=$((failures + 1)); }

# forbid REASON PATTERN FILES...: no line of the files may match.
forbid() {
  local reason=$1 pattern=$2 found
  shift 2
  found=$(grep -nE -- "$pattern" "$@" /dev/null)
  [ -z "$found" ] || fail "$reason:"$'\n'"$found"
}
# except LIST FILES...: the files whose names are not in the list of words.
except() {
  local list=" $1 " file
  shift
  for file in "$@"; do [[ $list == *" $(basename "$file") "* ]] || echo "$file"; done
}

shopt -s nullglob
mapping=(mapping/*.[ch]pp) fem=(fem/*.[ch]pp) planner=(planner/*.[ch]pp)
[ ${#mapping[@]} -ge 5 ] && [ ${#fem[@]} -ge 10 ] && [ ${#planner[@]} -ge 20 ] || fail "sources not found below $PWD"

include='^[[:space:]]*#[[:space:]]*include[[:space:]]*'
forbid "includes run planner -> fem -> mapping" "${include}[<\"](\.\./)?(fem|planner)/" "${mapping[@]}"
forbid "includes run planner -> fem -> mapping" "${include}[<\"](\.\./)?planner/" "${fem[@]}"
forbid "include paths start at the root" "${include}\"(\.|[^/\"]*\")" "${mapping[@]}" "${fem[@]}" "${planner[@]}"
forbid "sources do not include tests" "${include}\"tests/" "${mapping[@]}" "${fem[@]}" "${planner[@]}"

# JSON: what reads and writes files and results. Methods (search, scoring, reach, strategy) know nothing of it.
json="case_document.hpp case_file.cpp case_file.hpp case_values.hpp case_writer.hpp json_text.hpp result_fields.hpp
  evaluation_log.cpp schedule_file.cpp plan.cpp cli.cpp cli.hpp"
json=$(echo $json $(cd planner && echo cli_*.cpp study.cpp study_files.* study_runner.cpp stress.hpp stress_table.cpp *_result_file.cpp report_file.cpp material_file.cpp))
mapfile -t others < <(except "$json" "${planner[@]}")
forbid "JSON is for reading and writing files" "${include}<nlohmann/" "${mapping[@]}" "${fem[@]}" "${others[@]}"

mapfile -t others < <(except "parallel.cpp" "${planner[@]}")
forbid "OpenMP only in planner/parallel.cpp" "${include}<omp\.h>|^[[:space:]]*#[[:space:]]*pragma[[:space:]]+omp" \
  "${mapping[@]}" "${fem[@]}" "${others[@]}"
mapfile -t others < <(except "vtu.cpp" "${planner[@]}")
forbid "VTK files are written in planner/vtu.cpp" "<VTKFile" "${mapping[@]}" "${fem[@]}" "${others[@]}"
# Third-party optimisers stay behind one source each.
mapfile -t others < <(except "nlopt_search.cpp" "${planner[@]}")
forbid "NLopt only in planner/nlopt_search.cpp" "${include}<nlopt" "${mapping[@]}" "${fem[@]}" "${others[@]}"
mapfile -t others < <(except "reach_ipopt.cpp reach_ipopt.hpp reach_nlp.cpp reach_nlp.hpp" "${planner[@]}")
forbid "Ipopt only in planner/reach_*" "${include}[<\"](coin/)?Ip[A-Z]" "${mapping[@]}" "${fem[@]}" "${others[@]}"

allowed=" CMakeLists.txt CMakePresets.json LICENSE README.md cases fem mapping planner scripts tests "
# The tree may belong to another user than the one who tests: git would refuse it.
tree=(git -c "safe.directory=*")
if "${tree[@]}" rev-parse --is-inside-work-tree >/dev/null 2>&1; then
  while IFS= read -r entry; do
    [[ $entry == .* || $allowed == *" $entry "* ]] || fail "'$entry' does not belong at the top level"
  done < <("${tree[@]}" ls-files | cut -d/ -f1 | sort -u)
fi
[ $failures = 0 ]
