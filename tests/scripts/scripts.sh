#!/usr/bin/env bash
# scripts/run finds the case among its arguments; scripts/sensitivity ranks; scripts/article gathers, and keeps what is
# complete; scripts/build configures anew where the cache is another folder's.
# Usage: scripts.sh DRAPEPLAN SOURCE_DIR JSON_VALUE
set -uo pipefail
. "$(dirname "$0")/../planner/cli/kit.sh"

# A checkout whose build does nothing and whose program prints its arguments.
root=$work/checkout
mkdir -p "$root/scripts" "$root/build/release" "$work/bin"
cp "$source/scripts/run" "$root/scripts/"
printf '#!/bin/sh\n' >"$root/scripts/build"
cat >"$root/build/release/drapeplan" <<PROGRAM
#!/bin/sh
[ "\$2" = --help ] && [ \$# = 2 ] && exec "$program" "\$@"
echo "\$@"
PROGRAM
chmod +x "$root/scripts/build" "$root/build/release/drapeplan"
default=$root/cases/flexdraper-5x5.json

runs() { same "$("$root/scripts/run" "${@:2}")" "plan $1" "run ${*:2}"; }  # runs WANTED ARGUMENTS...
runs "$default"
runs "$default --quiet --out o" --quiet --out o
runs "$default --set material=other.json" --set material=other.json
runs "$default --out x.json" --out x.json
runs "$default --out=x.json --json" --out=x.json --json
runs "$default --threads 2 --seed 3 --resume" --threads 2 --seed 3 --resume
runs "$default --set ply.angle=3 --set -x" --set ply.angle=3 --set -x
runs "a.json" a.json
runs "--quiet mine" --quiet mine
runs "--out o a b --set x=y" --out o a b --set x=y
runs "--json -- -mine" --json -- -mine
runs "$default --json --" --json --
runs "$default --out --" --out --
runs "--quiet --help" --quiet --help

# A program whose drapes depend on two fields, and fail with a third value.
mkdir -p "$root"/cases/{materials,schedules}
cp "$source"/scripts/{sensitivity,article} "$root/scripts/"
touch "$root"/cases/{cantilever-150,cantilever-70,bias-extension,flexdraper-4,flexdraper-5x5}.json
cat >"$root/build/release/drapeplan" <<PROGRAM
#!/bin/sh
echo "\$@" >>"$work/calls"
gap=10 offset=20
for argument; do
  case \$argument in
    *pad_radius=10*) gap=15 ;;
    *joint_offset=10*) offset=60 ;;
    *coefficient=3) exit 3 ;;
  esac
done
echo "largest gap \$gap mm; r.m.s. gap 3 mm; largest boundary offset \$offset mm; largest fibre tension 1.5 %; x"
while [ \$# -gt 0 ]; do
  if [ "\$1" = --out ]; then
    mkdir -p "\$2"
    printf '{\n  "max_gap": 0.01234,\n  "max_boundary_offset": 0.0277\n}\n' >"\$2/result.json"
  fi
  shift
done
PROGRAM
"$root/scripts/sensitivity" "$default" screen >"$work/table" 2>"$work/stderr" || fail "sensitivity: $(cat "$work/stderr")"
ranked() { same "$(sed -n "$1p" "$work/table" | cut -d'|' -f2-4)" "$2" "row $1 of the sensitivity"; }
ranked 3 ' as in the case |  | 10 '
ranked 4 ' friction 3 | 0 | failed '
ranked 5 ' joint offset 10 mm | 200 | 10 '
ranked 6 ' pad radius 10 mm | 50 | 15 '
ranked 7 ' generators: axes | 0 | 10 '

calls() { wc -l <"$work/calls"; }
rm "$work/calls"
"$root/scripts/article" "$work/article" >"$work/stdout" 2>"$work/stderr" || fail "article: $(cat "$work/stderr")"
first=$(calls)
grep -qF '12.3 mm, 27.7 mm' "$work/article/index.html" || fail "the index of the article has no figures"
"$root/scripts/article" "$work/article" >"$work/stdout" 2>"$work/stderr" || fail "article: $(cat "$work/stderr")"
same "$(calls)" "$first" "calls of the program where all is complete"
touch "$root/cases/cantilever-70.json"
"$root/scripts/article" "$work/article" >"$work/stdout" 2>"$work/stderr" || fail "article: $(cat "$work/stderr")"
same "$(calls)" "$((first + 2))" "calls of the program after one case was changed"

# CMake is played by a script that notes what it is called with.
cp "$source/scripts/build" "$root/scripts/"
printf '#!/bin/sh\necho "$@" >>"%s"\n' "$work/calls" >"$work/bin/cmake"
printf '#!/bin/sh\nprintf installed\n' >"$work/bin/dpkg-query"
chmod +x "$work/bin/cmake" "$work/bin/dpkg-query"
cache() { printf 'CMAKE_CACHEFILE_DIR:INTERNAL=%s\nCMAKE_HOME_DIRECTORY:INTERNAL=%s\n' "$2" "$1" >"$root/build/release/CMakeCache.txt"; }
# configures FRESH WHAT: whether scripts/build asks for a fresh cache.
configures() {
  rm -f "$work/calls"
  PATH=$work/bin:$PATH "$root/scripts/build" ci target 2>"$work/stderr" || fail "$2: $(cat "$work/stderr")"
  same "$(head -n 1 "$work/calls")" "--preset ci$1" "$2"
  same "$(sed -n 2p "$work/calls")" "--build --preset ci --target target" "$2"
}
configures "" "no cache"
cache "$root" "$root/build/release"
configures "" "its own cache"
cache "$work/elsewhere" "$work/elsewhere/build/release"
configures " --fresh" "the cache of a checkout that was moved"
cache "$source" "$source/build/release"
configures " --fresh" "the cache of another checkout"
cache "$root" "$root/build/debug"
configures " --fresh" "the cache of another folder of this checkout"
ln -s "$root" "$work/link"
cache "$work/link" "$work/link/build/release"
configures "" "its own cache by way of a link"
finish 32
