#!/usr/bin/env bash
# Whatever bytes come in: a text that is no document is refused with its place, and what goes out is valid.
# Usage: documents.sh DRAPEPLAN SOURCE_DIR JSON_VALUE
set -uo pipefail
. "$(dirname "$0")/kit.sh"

# valid FILE...: UTF-8 without characters that XML does not allow; JSON is one document.
valid() {
  local file
  for file in "$@"; do
    checks=$((checks + 1))
    [ -s "$file" ] || fail "$file is absent or empty"
    iconv -f UTF-8 -t UTF-8 "$file" >"$work/utf8" 2>&1 || fail "$file is not UTF-8"
    [ "$(LC_ALL=C tr -d '\t\n\r\040-\176\200-\377' <"$file" | wc -c)" = 0 ] || fail "$file has control characters"
    case $file in *.json | */stdout) value "$file" "" >"$work/whole" ;; esac
  done
}

# damage NAME: makes NAME-case.json and NAME-schedule.json out of $work/good-*.json with the sed script on stdin.
damage() {
  sed -E -f - "$work/good-case.json" >"$work/$1-case.json" <"$work/script"
  sed -E -f - "$work/good-schedule.json" >"$work/$1-schedule.json" <"$work/script"
}

# refused NAME LINE TEXT: both files of that name are refused, on that line with that text, by `check` in its document too.
refused() {
  local name=$1 line=$2 text=$3
  damage "$name"
  expect 2 check "$work/$name-case.json" --json
  valid "$work/stdout"
  same "$(value "$work/stdout" /cases/0/valid)" false "check of $name"
  same "$(value "$work/stdout" /cases/0/errors/0/line)" "$line" "line of $name"
  value "$work/stdout" /cases/0/errors/0/message | grep -qF -- "$text" || fail "check of $name: no '$text': $(cat "$work/stdout")"
  refuse "$work/$name-case.json:$line: " simulate "$work/$name-case.json"
  refuse "$work/$name-schedule.json:$line: " simulate "$quick" --schedule "$work/$name-schedule.json"
  grep -qF -- "$text" "$work/stderr" || fail "schedule $name: no '$text': $(cat "$work/stderr")"
}

expect 0 check "$quick" --out "$work/check"
valid "$work/check"/{result,resolved}.json
cp "$work/check/resolved.json" "$work/good-case.json"
columns=$(value "$work/good-case.json" /grippers/columns) rows=$(value "$work/good-case.json" /grippers/rows)
{
  printf '{\n  "format": "drapeplan-schedule 1",\n  "blend_time": 0.1,\n  "grippers": [\n'
  for ((j = 1; j <= rows; ++j)); do
    for ((i = 1; i <= columns; ++i)); do
      printf '{"gripper": [%d, %d], "knots": [{"time": 0, "z": 0.3}, {"time": 2, "z": 0.29}]}' "$i" "$j"
      [ "$i,$j" = "$columns,$rows" ] && printf '\n' || printf ',\n'
    done
  done
  printf '  ]\n}\n'
} >"$work/good-schedule.json"
expect 0 check "$work/good-case.json"

deep() { printf "%${1}s" "" | tr ' ' '['; }
echo '1s/\{/{"caf\xE9": 1,/' >"$work/script"; refused latin1 1 'the byte 0xE9 is not text in UTF-8'
echo '1s/^/\xEF\xBB\xBF/' >"$work/script"; refused bom 1 'byte order mark'
echo '$s/$/\n\x00 anything/' >"$work/script"; damage nul
lines=$(($(wc -l <"$work/good-schedule.json") + 1))
refuse "$work/nul-schedule.json:$lines: column 1: the byte 0x00" simulate "$quick" --schedule "$work/nul-schedule.json"
refuse 'the byte 0x00' map "$work/nul-case.json"
echo '1s/\{/{"a": "\\ud800",/' >"$work/script"; refused surrogate 1 'surrogate'
echo '1s/\{/{"a": "\\u0000",/' >"$work/script"; refused escaped-nul 1 'NUL character'
echo '1s/\{/{\n"a": 1e400,/' >"$work/script"; refused overflow 2 'number overflow'
echo '1s/\{/{\n"a": 1e-400,/' >"$work/script"; refused underflow 2 'number underflow'
echo '1s/\{/{\n"format": 1,\n"format": 2,/' >"$work/script"; refused twice 3 'appears twice in this object; first on line 2'
echo '1s/\{/{\n"a": '"$(deep 64)"',/' >"$work/script"; refused deep 2 'nested deeper than 64 levels'
echo '1s/\{/{ \/\/ comment/' >"$work/script"; refused comment 1 'syntax error'
for order in UTF-16 UTF-16LE UTF-16BE; do
  iconv -f UTF-8 -t $order "$work/good-case.json" >"$work/wide.json"
  refuse "$work/wide.json:1: column " map "$work/wide.json"
  grep -qF 'UTF-16' "$work/stderr" || fail "$order is not named: $(cat "$work/stderr")"
done
sed 's/"blend_time"/"blend_tme"/' "$work/good-schedule.json" >"$work/misspelt.json"
refuse "$work/misspelt.json:3: /blend_tme: unknown key \"blend_tme\"; did you mean \"blend_time\"?" \
  simulate "$quick" --schedule "$work/misspelt.json"

# Bytes on the command line.
expect 2 check "$quick" --json --set "description=$(printf '\xfc')"
valid "$work/stdout"
expect 2 check "$quick" --json --set "$(printf 'pl\xfc=1')"
valid "$work/stdout"
expect 2 check "$(printf '%s/n\xf6.json' "$work")" --json
valid "$work/stdout"

# A good case whose name no document can hold as it is, with texts that markup must escape.
latin=$(printf '%s/caf\xe9 <&> \x01.json' "$work")
grep -vE '^  "name":' "$work/good-case.json" | sed '1s/{/{"description": "\\u0001\\ufffe <b> \& \\ud83d\\ude00",/;/^  "description":/d' >"$latin"
expect 0 check "$latin" --json
valid "$work/stdout"
expect 0 map "$latin" --json --out "$work/map"
valid "$work/stdout" "$work"/map/*.json
small=(--set optimise.evaluations=4 --set optimise.finalists=1)
expect 0 plan "$latin" --json "${small[@]}" --out "$work/plan"
valid "$work/stdout" "$work"/plan/*.{json,svg,html}
schedule=$(printf '%s/\xe9t\xe9 <\x02>.json' "$work")
cp "$work/plan/schedule.json" "$schedule"
expect 0 simulate "$latin" --schedule "$schedule" --json --out "$work/sim"
valid "$work/stdout" "$work"/sim/*.{json,svg}
finish 120
