#!/usr/bin/env bash
# skipped.sh REPORT [LIST]: names the tests that were skipped, by ctest's report (--output-junit). With a list of lines
# `NAME: what it says then`, fails when one that is not in it was skipped, or for another reason, or when it has more than
# five lines; and tells which of its lines were not needed.
set -euo pipefail
report=$1 list=${2-}
most=5

# Each test that was skipped, in a line: its name, a tab, all that it said.
skipped() {
    awk '
        /<testcase / { name = $0; sub(/.* name="/, "", name); sub(/".*/, "", name); text = ""; is_skipped = 0 }
        /<skipped/ { is_skipped = 1 }
        { gsub(/\t/, " "); text = text " " $0 }
        /<\/testcase>/ || /<testcase .*\/>/ { if (is_skipped) print name "\t" text; is_skipped = 0 }
    ' "$report" | sed "s/&apos;/'/g; s/&quot;/\"/g; s/&lt;/</g; s/&gt;/>/g; s/&amp;/\&/g"
}

declare -A said=()
while IFS=$'\t' read -r name text; do said[$name]=$text; done < <(skipped)
if [ -z "$list" ]; then
    for name in "${!said[@]}"; do echo "skipped: $name"; done | sort
    exit 0
fi

wrong=0 lines=0
declare -A listed=()
while IFS= read -r line; do
    case $line in '' | '#'*) continue ;; esac
    lines=$((lines + 1))
    listed[${line%%: *}]=${line#*: }
done <"$list"
[ "$lines" -le "$most" ] || { echo "$list has $lines lines: no more than $most tests may skip"; wrong=1; }
for name in "${!said[@]}"; do
    if [ -z "${listed[$name]-}" ]; then
        echo "skipped, and not in $list: $name"
        wrong=1
    elif [[ ${said[$name]} != *"${listed[$name]}"* ]]; then
        echo "skipped, but not for what $list says ('${listed[$name]}'): $name"
        wrong=1
    else
        echo "skipped: $name: ${listed[$name]}"
    fi
done
for name in "${!listed[@]}"; do
    [ -n "${said[$name]-}" ] || echo "may skip, and did not: $name"
done
exit "$wrong"
