#!/usr/bin/env bash
# Installs a build into a scratch folder, builds the program here with find_package, and plans a small case
# with it. Also wants that an installed copy for other instructions is refused.
# Usage: consumer.sh CMAKE SOURCE BUILD CXX CXX_FLAGS CONFIG
set -euo pipefail
cmake=$1 source=$2 build=$3 compiler=$4 flags=$5 config=$6
work=$(mktemp -d) && trap 'rm -rf "$work"' EXIT
fail() { echo "FAILED: $*" >&2; exit 1; }

cp -r "$source/tests/consumer" "$work/source"   # nothing is found beside the sources
"$cmake" --install "$build" --config "$config" --prefix "$work/installed" >"$work/log"
[ -x "$work/installed/bin/drapeplan" ] || fail "the program is not installed"
configure() {
  "$cmake" -S "$work/source" -B "$work/$1" -DCMAKE_PREFIX_PATH="$work/installed" -DCMAKE_CXX_COMPILER="$compiler" \
    -DCMAKE_CXX_FLAGS="$flags -O1 -Wall -Wextra -Wpedantic -Werror" >"$work/log" 2>&1
}
configure build || { cat "$work/log" >&2; fail "the consumer was not configured"; }
"$cmake" --build "$work/build" >"$work/log" 2>&1 || { cat "$work/log" >&2; fail "the consumer was not built"; }

"$work/build/consumer" "$source/cases/flexdraper-quick.json" "$work/out" optimise.evaluations=1 \
  optimise.finalists=1 'fem.mesh_size="25 mm"' >"$work/objectives"
cat "$work/objectives"
awk '$2 > 0 {value[$1] = $2}
     END {exit !(value["best"] > 0 && value["best"] <= value["uniform"] && value["best"] <= value["wave"])}' \
  "$work/objectives" || fail "the best is not at least as good as both baselines"

config_file=$(find "$work/installed" -name drapeplanConfig.cmake)
sed -i 's/size() == [0-9]*/size() == 3/' "$config_file"
configure other && fail "a copy for other instructions is taken"
grep -q "were built with" "$work/log" || fail "a copy for other instructions is refused without the reason"
