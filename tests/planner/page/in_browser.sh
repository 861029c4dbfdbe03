#!/usr/bin/env bash
# The page of a run in a browser: no errors, the view in space is drawn and does what its controls say, in light and
# dark; without WebGL it is hidden and the pictures are there.
# Usage: in_browser.sh DRAPEPLAN SOURCE_DIR JSON_VALUE CHROMIUM
set -uo pipefail
. "$(dirname "$0")/../cli/kit.sh"
chromium=$4 page=$work/page.html skipped=77   # the code that ctest knows for it

# browse FILE OPTIONS...: the page as it is after its scripts; what the browser's console says is in $work/console.
browse() {
  local file=$1
  shift
  HOME=$work "$chromium" --headless --no-sandbox --disable-gpu --disable-dev-shm-usage --user-data-dir="$work/profile" \
    --hide-scrollbars --window-size=900,1200 --enable-logging=stderr "$@" --dump-dom "file://$file" \
    >"$work/dom" 2>"$work/browser"
  # What a software driver says of its own speed is no error.
  grep CONSOLE "$work/browser" | grep -v 'GL Driver Message' >"$work/console"
  same "$(wc -l <"$work/console")" 0 "lines on the console ($(head -c 400 "$work/console"))"
}
# has WORDS WHAT: the page has these words.
has() {
  checks=$((checks + 1))
  grep -qF -- "$1" "$work/dom" || fail "$2"
}

# A browser that does not start here (no shared memory, no rights) says nothing of the page.
if ! HOME=$work "$chromium" --headless --no-sandbox --disable-gpu --disable-dev-shm-usage --user-data-dir="$work/profile" \
  --dump-dom about:blank >"$work/dom" 2>"$work/browser"; then
  echo "skipped: $chromium does not start: $(tail -n 1 "$work/browser")"
  exit "$skipped"
fi
expect 0 simulate "$quick" --fidelity screen --json --out "$work/run"
collect='window.pageErrors = []; addEventListener("error", (event) => pageErrors.push(event.message));
for (const name of ["error", "warn"]) console[name] = (...words) => pageErrors.push(words.join(" "));'
{
  while IFS= read -r line; do
    [ "$line" != "</body>" ] || printf '<script>\n%s\n</script>\n' "$(cat "$source/tests/planner/page/in_browser.js")"
    printf '%s\n' "$line"
    [ "$line" != "<head>" ] || printf '<script>%s</script>\n' "$collect"
  done <"$work/run/report.html"
} >"$page"

software=(--use-angle=swiftshader --enable-unsafe-swiftshader)
for theme in 1 0; do   # light, dark
  browse "$page" "${software[@]}" --blink-settings=preferredColorScheme=$theme
  has ' checks, 0 failed' "theme $theme: $(sed -n '/<pre>verdict/,/<\/pre>/p' "$work/dom"; tail -n 3 "$work/browser")"
done
browse "$work/run/report.html" --disable-3d-apis
has '<section class="view" id="view" hidden' "without WebGL the view is not hidden"
has '<figcaption>The ply in space' "without WebGL there are no pictures"
finish 7
