#!/usr/bin/env bash
# From synthetic raw data to a material that a case can use; and data that cannot be right.
# Usage: characterise.sh DRAPEPLAN SOURCE_DIR JSON_VALUE
set -uo pipefail
# shellcheck source=tests/planner/cli/kit.sh
. "$(dirname "$0")/kit.sh"
cd "$work" || exit 1

"$(dirname "$json_value")/synthetic_tests" data "$quick" || fail "no synthetic data"
expect 0 characterise data/tests.json --out found --json
within stdout /bias_extension/valid_to_deg 29.99 30.01
for k in 0 1 2 3; do within stdout /verifications/$k/error 0 0.1; done
same "$(value stdout /verifications/4/compared)" drop "what is compared of a cantilever"
within stdout /verifications/4/end_error 0 0.04
within stdout /verifications/5/end_error 0 0.04
within stdout /verifications/6/end_error 0 0.07
within stdout /cantilever/0/transverse_shear_modulus/24 1e4 1e7
same_file stdout found/result.json
value found/material.json /shear/valid_to | grep -q '^30 deg$\|^0.523' || fail "valid_to: $(value found/material.json /shear/valid_to)"
within found/material.json /shear/band 0.001 0.1
within found/material.json /tension/band 0.001 0.1
[ -s found/characterisation.html ] || fail "no page"
value found/material.json /shear/source >source
grep -q 'Bias extension of 9 specimens' source || fail "the material does not say where its shear is from"
value found/material.json /compression/source >source
grep -q 'a strip of 150 mm' source || fail "the material does not say where its compression is from"
grep -q 'cantilever of 70 mm: strip_70.csv' found/characterisation.html || fail "the page lacks a cantilever"
expect 0 characterise data/tests.json --set 'cantilever=[]' --set 'bias_extension=[]' --out short
value short/material.json /compression/source >source
grep -q 'Assumed, not tested' source || fail "the material does not say what was not tested"
expect 0 characterise data/tests.json --set 'cantilever=[]' --set 'bias_extension=[]' --out short
[ -s short/earlier-1/material.json ] && [ -s short/earlier-1/characterisation.html ] || fail "not set aside"
# A case takes the material.
sed 's#"material": "[^"]*"#"material": "'"$work"'/found/material.json"#' "$source/cases/bias-extension.json" >strip.json
expect 0 simulate strip.json --quiet

# broken SCRIPT FILE TEXT: the sed script spoils a file; then TEXT is on stderr.
broken() {
  rm -rf spoilt && cp -r data spoilt
  sed -i -E -e "$1" "spoilt/$2"
  refuse "$3" characterise spoilt/tests.json
  grep -q "spoilt/" stderr || fail "the message names no file: $(head -c 300 stderr)"
}
broken 's/Load \(N\)/Load/' tension_2_1.csv ':2: Load: has no unit'
broken 's/Load/Weight/' tension_2_1.csv 'no row names columns for'
broken 's/Extension \(mm\),Load \(N\)/Load (N),Extension (mm)/' tension_2_1.csv 'the wrong unit, size or column'
broken '3,$d' bias_10_1.csv 'has 0 rows of numbers'
broken '100{h;d};300{G}' bias_10_1.csv 'rows are not in their order'
broken '400s/,[0-9.]+$/,-1/' bias_100_2.csv 'did the specimen slip'
broken 's/"height": "270 mm"/"height": "230 mm"/' tests.json 'is less than twice the width'
broken 's/"rate": "10 mm\/min"/"rate": "20 mm\/min"/' tests.json "but the test's rate is 20 mm/min"
broken 's/"file": "steel_1.csv"/"file": "steel_9.csv"/' tests.json 'cannot be read'
broken '50{h;d};80{G}' strip_70.csv 'rows are not in their order'
broken '40s/;.*/;75/' strip_70.csv ':40: deflection: 75 mm is deeper than the strip is long, 70 mm'
broken 's/;([0-9])/;-\1/' strip_70.csv 'lies above the clamp'
broken 's/Time \(s\);Deflection \(mm\)/Deflection (mm);Time (s)/' strip_70.csv 'or columns are swapped'
broken 's/Deflection \(mm\)/Deflection/' strip_70.csv ':2: Deflection: has no unit'
broken '/"scale"/d' tests.json '/cantilever/0: "scale" is missing'
broken 's/"scale": "0.2 mm"/"scale": "0.3 mm"/' tests.json 'mm long, not 150 mm: the wrong scale'
broken 's/"scale"/"threshold": 0.95, "scale"/' tests.json 'strip_01.pgm: shows no strip'
broken 's/"scale"/"clamp_right": true, "scale"/' tests.json 'is the clamp on the other side'
broken 's/strip_01.pgm/strip_99.pgm/' tests.json 'strip_99.pgm: cannot be read as an image'
broken 's/"strip_01.pgm"/"tests.json"/' tests.json 'tests.json: cannot be read as an image'
broken 's/"time": "0.4 s"/"time": "0.8 s"/' tests.json 's": times must increase'
broken 's/"file": "steel_[123].csv"/"file": "bias_10_1.csv"/' tests.json \
  'is `compliance` of this machine?'
broken '60s/,[0-9.]+$/,1e9/' tension_2_1.csv ':60: force: 1e+09 N is more than this specimen bears'
broken '60s/,[0-9.]+$/,400/' tension_2_1.csv ':60: force: 400 N lies far above the rows before and after it'
broken '60s/,([0-9]+)[.]/,\1,/' tension_2_1.csv ':60: has 4 cells, but line 2 names 3 columns'
broken '1,2!s/,[0-9.-]+$/,5/' tension_2_1.csv ':3: force: 5 N is the largest one: no curve lies before it'
broken '1,2!s/;.*/;0/' strip_70.csv "is less than 1 % of the strip's length"
rm -rf spoilt && cp -r data spoilt && truncate -s 200000 spoilt/strip_20.pgm
refuse 'strip_20.pgm: cannot be read as an image: it is cut off' characterise spoilt/tests.json
# One picture is no history.
expect 3 characterise data/tests.json --out few --set 'tension=[]' --set 'bias_extension=[]' --set \
  'cantilever=[{"length": "150 mm", "width": "25 mm", "scale": "0.2 mm", "frames": [{"file": "strip_01.pgm", "time": "0.4 s"}]}]'
grep -q 'was seen at 1 times' stderr || fail "one picture: $(head -c 300 stderr)"
# A strip's shape at rest, which is a parabola here: it is shown, and nothing of the material is taken from it.
{ echo 'x (mm),Deflection (mm)'; for k in {0..100}; do echo "$k,$((k * k * 6))e-3"; done; } >data/shape.csv
expect 0 characterise data/tests.json --set 'tension=[]' --set 'bias_extension=[]' --set \
  'cantilever=[{"length": "120 mm", "width": "25 mm", "profile": "shape.csv"}]' --out shape --json
within stdout /profile/0/drop 0.0599 0.0601
within stdout /profile/0/curvature/8 5 15
within stdout /profile/0/material/drop 0.03 0.08
lacks stdout /compression /cantilever
grep -q 'from the profile' shape/characterisation.html || fail "the page lacks the profile"
for field in 'gravity=1e-320 m/s^2' 'thickness=1e-9 mm' 'areal_density=1e-300 g/m^2'; do
  refuse "/${field%=*}: " characterise data/tests.json --set "$field"
done
refuse 'none.json: cannot be read' characterise none.json
refuse 'is not tested' characterise data/tests.json --set assumed=null --set 'cantilever=[]'
refuse 'must be given or assumed' characterise data/tests.json --set assumed=null
finish 61
