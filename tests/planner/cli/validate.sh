#!/usr/bin/env bash
# All comparisons with outside data agree; what the verb writes, and what it refuses.
# Usage: validate.sh DRAPEPLAN SOURCE_DIR JSON_VALUE
set -uo pipefail
# shellcheck source=tests/planner/cli/kit.sh
. "$(dirname "$0")/kit.sh"
cd "$work" || exit 1

expect 0 validate --out found --json --quiet
same_file stdout found/result.json
within stdout /verdicts/agrees 60 1000
within stdout /verdicts/differs -0.5 0.5
for key in reference ours tolerance verdict source; do value stdout /rows/0/$key >value; done
grep -q '^## mapping' found/validate.md || fail "no table of the mapping"
grep -q '<svg' found/validation.html || fail "no picture on the page"

expect 0 validate --only 'mapping: net on a sphere' --out found
grep -q 'unit sphere, cell 11 along the diagonal' stdout || fail "no row of the sphere on the console"
grep -q 'earlier-1' stderr || fail "it does not say that earlier results were set aside"
[ -s found/earlier-1/validation.html ] || fail "the earlier page is lost"
refuse 'no comparison' validate --only 'no such comparison'
refuse '--set and --seed' validate --set fem.rates=false
expect 2 stress --only 'size: two elements' --out found
finish 13
