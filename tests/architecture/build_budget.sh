#!/usr/bin/env bash
# build_budget.sh ROOT BUDGET <DEPENDENCIES: fails where a room has the compiler read more lines than BUDGET grants it.
# DEPENDENCIES is what `ninja -t deps` prints: for each object, all the files that were read for it, those of the system
# too. Their lines are what most of a build's time goes into, and are the same however busy the machine is.
set -euo pipefail
root=$1 budget=$(realpath "$2")

# "room path" for each file that an object of the product was made of.
reads=$(awk '
    /^[^ ].*: #deps/ { room = $1; sub(/\/CMakeFiles\/.*/, "", room); wanted = room !~ /^(tests|bench)(\/|$)/ && !/_verify_|verify_interface/ }
    /^ +[^ ]/ && wanted { print room, $1 }')
[ -n "$reads" ] || { echo "nothing is known of what was compiled: build first"; exit 1; }

cd "$root"
counts=$(mktemp)
trap 'rm -f "$counts"' EXIT
cut -d ' ' -f 2 <<<"$reads" | sort -u | tr '\n' '\0' | xargs -0 wc -l 2>/dev/null | awk '$2 != "total" { print $2, $1 }' >"$counts" || true

awk -v counts="$counts" -v budget="$budget" '
    BEGIN {
        while ((getline line < counts) > 0) { split(line, part, " "); lines[part[1]] = part[2] }
        while ((getline line < budget) > 0) if (line !~ /^#/ && split(line, part, " ") == 2) granted[part[1]] = part[2] * 1000
    }
    { read[$1] += lines[$2]; of[$1, $2] += lines[$2]; files[$1] = files[$1] " " $2 }
    END {
        for (room in read) {
            total += read[room]
            if (!(room in granted)) { print room " has no line in " budget "; it reads " read[room] " lines"; wrong = 1; continue }
            if (read[room] <= granted[room]) continue
            wrong = 1
            most = ""
            n = split(files[room], all, " ")
            for (i = 1; i <= n; i++) if (most == "" || of[room, all[i]] > of[room, most]) most = all[i]
            print room " reads " read[room] " lines, and " granted[room] " are granted; the most are those of " most " (" of[room, most] ")"
        }
        for (room in granted) if (!(room in read)) { print room " is in " budget ", and nothing of it was compiled"; wrong = 1 }
        print "all rooms: " total " lines"
        exit wrong
    }' <<<"$reads"
