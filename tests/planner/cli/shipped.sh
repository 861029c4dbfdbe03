#!/usr/bin/env bash
# What holds for every shipped case: books, hourglass energy, penetration, and a step near its true limit.
# Usage: shipped.sh DRAPEPLAN SOURCE_DIR JSON_VALUE CASE [OPTIONS of simulate...]
set -uo pipefail
. "$(dirname "$0")/kit.sh"
case_file=$source/cases/$4.json
shift 4

expect 0 simulate "$case_file" --json "$@"
within "$work/stdout" /energy/balance_error 0 1e-9
within "$work/stdout" /largest_hourglass_share 0 0.02
# Figures of what the case does not have are absent.
terms=$(value "$work/stdout" /terms)
case $terms in
  *contact*) within "$work/stdout" /largest_penetration 0 15e-6 ;;   # a twentieth of the thickness
  *) lacks "$work/stdout" /largest_penetration ;;
esac
case $terms in
  *interlinks* | *"fixed joint"*) within "$work/stdout" /largest_link_error 0 1e-7 ;;   # a millionth of 100 mm
  *) lacks "$work/stdout" /largest_link_error ;;
esac
within "$work/stdout" /stable_step/share 0.78 1.001   # of the true limit, at the end: 0.80 to 0.98
value "$work/stdout" /stable_step/share
value "$work/stdout" /largest_hourglass_share
finish 6
