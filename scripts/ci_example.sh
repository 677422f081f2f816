#!/bin/bash
# Runs the commands of docs/ci.md exactly as they stand there, both files of them, the installation apart, with the GLSL twin (tests/twin) as somebody's GPU implementation; then with an
# error in the twin, which must end in 1. Times each command.
#   scripts/ci_example.sh [BUILD]        default build/release
# Says SKIPPED, and ends with 0, where the twin is not built or there is no OpenGL 4.5.
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
build=$(realpath "${1:-$root/build/release}")
twin=$build/tests/twin/lrsm_twin
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
mkdir "$dir/bin"
ln -s "$build/apps/lrsm" "$dir/bin/lrsm"
if [ ! -x "$twin" ]; then
    echo "ci_example: SKIPPED: tests/twin is not built"
    exit 0
fi
# PLANT: an error of the twin's list.
cat >"$dir/bin/my_renderer" <<END
#!/bin/sh
"$twin" "\$1" --from-golden -o "\$2" \${PLANT:+--plant \$PLANT} >/dev/null; [ \$? -le 1 ]
END
cat >"$dir/bin/my_equations" <<END
#!/bin/sh
"$twin" --vectors "\$1" >/dev/null
END
chmod +x "$dir/bin/"*
export PATH=$dir/bin:$PATH

# The block of docs/ci.md after the line that names $1, its commands alone: of "- run: X" and of "- X" under script.
commands() {
    awk -v file="$1" 'index($0, file) { found = 1 } found && /^```yaml/ { inside = 1; next } inside && /^```/ { exit } inside' "$root/docs/ci.md" |
        sed -nE 's/^ +- (run: )?((lrsm|my_[a-z]+) .*)$/\2/p'
}
# Runs them like a CI server: the first that fails ends it. Exit code of that.
job() {
    local start=$SECONDS line begin
    mkdir "$dir/$2" && cd "$dir/$2"
    while read -r line; do
        begin=${EPOCHREALTIME/./}
        if bash -c "$line" >log 2>&1; then code=0; else code=$?; fi
        printf 'ci_example: %-28s %5.1f s, exit code %d   %s\n' "$1" "$(awk "BEGIN { print (${EPOCHREALTIME/./} - $begin) / 1e6 }")" "$code" "${line:0:60}"
        [ $code = 0 ] || { head -n 3 log; return $code; }
    done < <(commands "$1")
    printf 'ci_example: %s: passed in %d s\n' "$1" $((SECONDS - start))
}
for file in .github/workflows/golden.yml .gitlab-ci.yml; do [ "$(commands $file | wc -l)" = 6 ] || { echo "ci_example: FAILED: docs/ci.md has not six commands for $file"; exit 1; }; done
lrsm validate --vectors "$dir/try" --equation 5 --quiet
if ! my_equations "$dir/try" 2>"$dir/why"; then
    echo "ci_example: SKIPPED: $(cat "$dir/why")"
    exit 0
fi
job .github/workflows/golden.yml github
job .gitlab-ci.yml gitlab
for report in golden.xml vectors.xml; do [ -s "$dir/github/$report" ] && [ -s "$dir/gitlab/$report" ] || { echo "ci_example: FAILED: no $report"; exit 1; }; done
code=0
PLANT=alpha job .gitlab-ci.yml wrong || code=$?
[ $code = 1 ] && grep -q '<failure' "$dir/wrong/golden.xml" || { echo "ci_example: FAILED: an error in the twin gave exit code $code"; exit 1; }
echo "ci_example: passed in $SECONDS s: an error of the twin ends in exit code 1"
