#!/usr/bin/env bash
# skipped_test.sh: what is skipped without leave fails, and what may be is named.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cat >"$folder/report.xml" <<'XML'
<testsuite name="(empty)" tests="3" failures="0" disabled="0" skipped="2">
	<testcase name="Good.Passes" classname="Good.Passes" time="0.1" status="run">
		<system-out>a small disk, GTEST_SKIP</system-out>
	</testcase>
	<testcase name="Disk.IsSmall" classname="Disk.IsSmall" time="0.1" status="notrun">
		<skipped message="SKIP_REGULAR_EXPRESSION_MATCHED"/>
		<system-out>x.cpp:1: Skipped
it can&apos;t mount a small disk
</system-out>
	</testcase>
	<testcase name="Dot.IsRead" classname="Dot.IsRead" time="0.1" status="notrun">
		<skipped message="SKIP_RETURN_CODE=77"/>
		<system-out>no Graphviz</system-out>
	</testcase>
</testsuite>
XML
# expect CODE LIST WORDS: so it ends, and says that.
expect() {
    local code=0 said
    printf '%s\n' "$2" >"$folder/list"
    said=$("$here/skipped.sh" "$folder/report.xml" "$folder/list" 2>&1) || code=$?
    [ "$code" -eq "$1" ] || { echo "ended with $code, not $1, for the list '$2': $said"; exit 1; }
    [[ $said == *"$3"* ]] || { echo "wanted '$3', and it says: $said"; exit 1; }
}
both=$'# of two\nDisk.IsSmall: can\'t mount a small disk\nDot.IsRead: no Graphviz'
expect 0 "$both" "skipped: Disk.IsSmall: can't mount a small disk"
expect 1 "Dot.IsRead: no Graphviz" "not in $folder/list: Disk.IsSmall"
expect 1 "${both/mount/find}" "not for what"
expect 0 "$both"$'\nGood.Passes: never' "may skip, and did not: Good.Passes"
expect 1 "$both"$'\na: b\nc: d\ne: f\ng: h' "no more than 5"
said=$("$here/skipped.sh" "$folder/report.xml")
[ "$said" = $'skipped: Disk.IsSmall\nskipped: Dot.IsRead' ] || { echo "without a list it says: $said"; exit 1; }
