#!/usr/bin/env bash
# One way for errors: every verb, on the same list of wrong inputs, refused places and broken streams, ends with 2 or
# 3, names the place and the reason, leaves nothing behind, and never speaks of a bug.
# Usage: errors.sh DRAPEPLAN SOURCE_DIR JSON_VALUE
set -uo pipefail
# shellcheck source=tests/planner/cli/kit.sh
source "$(dirname "$0")/kit.sh" "$(realpath "$1")" "$(realpath "$2")" "$3"
cd "$work" || exit 1   # verbs without --out write below ./out

# Coarse and short: what goes on although it should be refused is over soon.
coarse=(--set 'fem.mesh_size=34 mm' --set 'fidelities={}' --set fem.time_scaling=30 --set optimise.evaluations=2
  --set optimise.finalists=1)

# denied CODE TEXT ARGUMENTS...: that exit code, TEXT on stderr, no bug, nothing on stdout; no output folder with 2.
denied() {
  local code=$1 text=$2
  shift 2
  expect "$code" "$@"
  grep -qF -- "$text" stderr || fail "no '$text' on stderr: $*: $(head -c 400 stderr)"
  ! grep -q 'a bug' stderr || fail "a bug: $*: $(head -c 400 stderr)"
  [ ! -s stdout ] || fail "something on stdout: $*"
  [ "$code" != 2 ] || { [ ! -e out ] && [ ! -e refused ]; } || fail "something was written: $*"
  rm -rf out refused
}

# The command line of a verb up to its case.
command_of() {
  case $1 in
    bench) echo "bench --scene case --steps 1 --repeats 1" ;;
    study) echo "study --part mapping --repeats 1" ;;
    *) echo "$1" ;;
  esac
}

long=$(printf 'a%.0s' {1..300})
ln -s loop loop
mkdir folder
touch file
echo '{ "format": "drapeplan-case 1", ' >syntax.json
printf '\xff\xfe{\x00}\x00' >utf16.json
{ echo 'Extension (mm),Load (N)'; for k in {0..20}; do echo "0.0$((k + 10)),$k"; done; } >pull.csv
echo '{"format": "drapeplan-tests 1", "thickness": "0.3 mm", "areal_density": "314 g/m^2",
  "tension": [{"file": "pull.csv", "width": "25 mm", "height": "150 mm", "rate": "2 mm/min"}],
  "assumed": "'"$source"'/cases/materials/bmi-4hs.json"}' >tests.json

# A verb's own document, a wrong unit and a wrong key in it.
declare -A document=([characterise]=tests.json) unit=([characterise]='thickness=1 mn') key=([characterise]='thicknes=1 mm')
for verb in map reach simulate plan bench study check characterise; do
  # shellcheck disable=SC2207
  words=($(command_of $verb))
  place=(--out refused)
  [ $verb != check ] || place=()
  denied 2 none.json "${words[@]}" none.json "${place[@]}"
  denied 2 "folder: cannot be read: it is a folder" "${words[@]}" folder "${place[@]}"
  denied 2 "loop: cannot be read: " "${words[@]}" loop "${place[@]}"
  denied 2 "$long: cannot be read: " "${words[@]}" "$long" "${place[@]}"
  denied 2 syntax.json: "${words[@]}" syntax.json "${place[@]}"
  denied 2 utf16.json "${words[@]}" utf16.json "${place[@]}"
  words+=("${document[$verb]-$quick}")
  denied 2 'unknown unit "mn"' "${words[@]}" "${place[@]}" --set "${unit[$verb]-ply.width=1 mn}"
  denied 2 ': unknown key' "${words[@]}" "${place[@]}" --set "${key[$verb]-ply.widht=1 mm}"
  denied 2 'nothing' "${words[@]}" "${place[@]}" --set nothing
  denied 2 '--wrong' "${words[@]}" "${place[@]}" --wrong
  denied 2 '--threads' "${words[@]}" "${place[@]}" --threads 0
done
denied 2 '/ply/widht: unknown key' map "$quick" --set 'ply.widht=1 mm' --out refused
denied 2 'folder: cannot be read: it is a folder' characterise tests.json --out refused \
  --set 'tension=[{"file": "folder", "width": "25 mm", "height": "150 mm", "rate": "2 mm/min"}]'
mkfifo pipe
for place in pipe /dev/zero; do
  denied 2 "$place: cannot be read: it is no regular file" characterise tests.json --out refused \
    --set 'tension=[{"file": "'$place'", "width": "25 mm", "height": "150 mm", "rate": "2 mm/min"}]'
  denied 2 "$place: cannot be read as an image: it is no regular file" characterise tests.json --out refused \
    --set 'cantilever=[{"length": "150 mm", "width": "25 mm", "scale": "1 mm", "frames": [{"file": "'$place'", "time": "1 s"}]}]'
  denied 2 '"'$place'" cannot be read: it is no regular file' characterise tests.json --set assumed=$place --out refused
  denied 2 'cannot be read: it is no regular file' check "$quick" --set "material=$(realpath $place)"
done
denied 2 '/dev/zero: cannot be read: it is larger than 256 MB' check /dev/zero
denied 2 'no scene' stress --only 'no such scene' --out refused
denied 2 '--set and --seed' stress --set fem.rates=false --out refused
denied 2 'no comparison' validate --only 'no such comparison' --out refused
denied 2 '--set and --seed' validate --seed 1 --out refused
denied 2 'did you mean "grippers.joint_offset"' explain grippers.joint_ofset --out refused

# Scenes that cannot be built, plies that cannot be mapped.
stiff=(--set 'grippers.actuator_stiffness=1e12 N/m')
steep=(--set mold='{"shape": "sphere", "extent": [["-60 mm", "60 mm"], ["-60 mm", "60 mm"]], "centre": ["0 mm", "0 mm", "0 mm"], "radius": "50 mm"}'
  --set 'mapping.start=["0 mm", "0 mm"]')
for verb in simulate plan; do
  denied 2 "$quick: " $verb "$quick" "${coarse[@]}" "${stiff[@]}" --quiet --out refused
done
denied 2 "$quick: " bench "$quick" --scene case --steps 1 --repeats 1 "${stiff[@]}" --quiet --out refused
denied 2 "$quick: " bench "$quick" --scene drape-10mm --steps 1 --repeats 1 "${stiff[@]}" --quiet --out refused
for verb in map reach simulate plan study; do
  # shellcheck disable=SC2046
  denied 3 "the ply cannot be mapped" $(command_of $verb) "$quick" "${coarse[@]}" "${steep[@]}" --quiet
done

# Places of results that the system refuses: named with its reason, before any work.
places=(/proc/nope "$long" loop/x file/x file)
reasons=(/proc/nope "File name too long" "Too many levels of symbolic links" "Not a directory" "file: ")
if [ "$(id -u)" != 0 ]; then
  mkdir closed && chmod 500 closed
  places+=(closed/x) reasons+=("Permission denied")
fi
for verb in map reach simulate plan bench study check characterise stress validate schema explain; do
  # shellcheck disable=SC2207
  words=($(command_of $verb))
  case $verb in
    stress) words+=(--only 'size: two elements') ;;
    validate) words+=(--only 'bending: softening strip') ;;
    schema) ;;
    explain) words+=(grippers) ;;
    check | map | reach | characterise) words+=("${document[$verb]-$quick}") ;;
    *) words+=("$quick" "${coarse[@]}") ;;
  esac
  for k in "${!places[@]}"; do
    denied 2 "${reasons[k]}" "${words[@]}" --quiet --out "${places[k]}"
    grep -qF -- "${places[k]}" stderr || fail "$verb: ${places[k]} is not named: $(head -c 400 stderr)"
    same "$(wc -l <stderr)" 1 "lines on stderr of $verb --out ${places[k]}"
  done
done
[ -f file ] && [ ! -s file ] && [ -L loop ] && [ -z "$(ls folder)" ] || fail "a refused place was changed"
denied 2 loop simulate "$quick" "${coarse[@]}" --schedule loop --out refused --quiet
denied 2 folder simulate "$quick" "${coarse[@]}" --schedule folder --out refused --quiet
denied 2 "$long" simulate "$quick" "${coarse[@]}" --schedule "$long" --out refused --quiet
denied 2 loop simulate "$quick" "${coarse[@]}" --restart loop --out refused --quiet

# Not enough memory is no bug. (A sanitizer's own needs do not fit below such a limit.)
if ! grep -q __asan_init "$program" && ! grep -q __tsan_init "$program"; then
  for verb in simulate plan; do
    (ulimit -v 250000 && "$program" $verb "$quick" --set 'fem.mesh_size=0.2 mm' --set 'fidelities={}' --quiet --threads 1 \
      --out refused >stdout 2>stderr)
    same $? 3 "exit code of $verb without memory"
    grep -q 'not enough memory for about [0-9]* nodes' stderr || fail "$verb: memory is not named: $(head -c 400 stderr)"
    rm -rf refused
  done
fi

# A limit on the size of files is named.
(ulimit -f 4 && "$program" simulate "$quick" "${coarse[@]}" --quiet --out refused >stdout 2>stderr)
same $? 3 "exit code with a limit on files"
grep -q 'File too large' stderr || fail "the limit on files is not named: $(head -c 400 stderr)"
rm -rf refused

# Streams that are closed or whose reader is gone: the results are on disk all the same.
run_drape=(simulate "$quick" "${coarse[@]}" --frames 2)
(exec >&- 2>&- <&-; exec "$program" "${run_drape[@]}" --out closed-streams)
same $? 0 "exit code with closed streams"
"$program" "${run_drape[@]}" --out open-streams >stdout 2>stderr
for file in schedule.json schedule.csv drape.svg ply.pvd resolved.json; do
  same_file closed-streams/$file open-streams/$file
done
declare -A fewer=([reach]=--no-changes)
for verb in map reach simulate; do
  # A reader that is gone for certain: the program starts when it has ended.
  { sleep 0.3; "$program" $verb "$quick" "${coarse[@]}" ${fewer[$verb]-} --out gone-$verb 2>stderr; echo $? >code; } | true
  same "$(cat code)" 0 "exit code of $verb without a reader"
  checks=$((checks + 1))
  [ -s gone-$verb/result.json ] && [ -s gone-$verb/resolved.json ] || fail "$verb lost its results"
  { sleep 0.3; "$program" $verb "$quick" "${coarse[@]}" ${fewer[$verb]-} 2>stderr; echo $? >code; } | true
  same "$(cat code)" 3 "exit code of $verb without a reader and without files"
  ! grep -q 'a bug' stderr || fail "$verb: a bug: $(cat stderr)"
done
finish 200
