# What the command-line tests share; sourced with: DRAPEPLAN SOURCE_DIR JSON_VALUE
program=$1 source=$2 json_value=$3
work=$(mktemp -d) && trap 'rm -rf "$work"' EXIT
quick=$source/cases/flexdraper-quick.json
failures=0 checks=0
[ -x "$json_value" ] || { echo "FAILED: $json_value is not built: values cannot be looked up" >&2; exit 1; }
fail() { echo "FAILED: $*" >&2; failures=$((failures + 1)); }

# expect CODE ARGUMENTS...: runs the program, keeps its output in $work/stdout and $work/stderr.
expect() {
  local code=$1
  shift
  "$program" "$@" >"$work/stdout" 2>"$work/stderr"
  local got=$?
  checks=$((checks + 1))
  [ "$got" = "$code" ] || fail "exit $got instead of $code: $*: $(head -c 400 "$work/stderr")"
}

# says TEXT [FILE]: the text stands on stderr, or in a file of $work.
says() {
  local in=${2:-stderr}
  checks=$((checks + 1))
  grep -qF -- "$1" "$work/$in" || fail "no '$1' on $in: $(head -c 400 "$work/$in")"
}

# refuse TEXT ARGUMENTS...: exit 2, TEXT on stderr, nothing on stdout, no output folder.
refuse() {
  local text=$1
  shift
  expect 2 "$@" --out "$work/refused"
  grep -qF -- "$text" "$work/stderr" || fail "no '$text' on stderr: $*: $(head -c 400 "$work/stderr")"
  [ ! -s "$work/stdout" ] || fail "something on stdout: $*"
  [ ! -e "$work/refused" ] || fail "something was written: $*"
  rm -rf "$work/refused"
}

# value FILE POINTER [LOW HIGH]: prints a value; fails outside the range.
value() {
  checks=$((checks + 1))
  "$json_value" "$@" 2>"$work/value_error" || fail "$(cat "$work/value_error")"
}
# Within a range, without printing it.
within() { value "$@" >"$work/value"; }
# lacks FILE POINTER...: none of these is there.
lacks() {
  local file=$1 pointer
  shift
  for pointer in "$@"; do
    checks=$((checks + 1))
    if "$json_value" "$file" "$pointer" >"$work/value" 2>&1; then fail "$file has $pointer: $(cat "$work/value")"; fi
  done
}

same() {
  checks=$((checks + 1))
  [ -n "$1" ] && [ "$1" = "$2" ] || fail "$3: '$1' and '$2'"
}
same_file() {
  checks=$((checks + 1))
  [ -s "$1" ] && cmp -s "$1" "$2" || fail "$1 and $2 differ"
}

# finish AT_LEAST: the test's exit status; too few checks mean that the script has skipped some.
finish() {
  [ "$checks" -ge "$1" ] || fail "only $checks checks were made, expected at least $1"
  echo "$checks checks, $failures failed"
  [ "$failures" = 0 ]
}
