#!/usr/bin/env bash
# build_budget_test.sh: build_budget.sh tells rooms that read too much, that nobody granted anything, and that are gone.
set -euo pipefail
script=$(dirname "$(realpath "$0")")/build_budget.sh
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"

seq 2000 >large.hpp
seq 500 >small.hpp
cat >deps <<'END'
core/room/CMakeFiles/room.dir/one.cpp.o: #deps 2, deps mtime 1 (VALID)
    large.hpp
    small.hpp

core/room/CMakeFiles/room.dir/two.cpp.o: #deps 1, deps mtime 1 (VALID)
    large.hpp

tests/room/CMakeFiles/room_test.dir/test.cpp.o: #deps 1, deps mtime 1 (VALID)
    large.hpp

END

# expect STATUS TEXT BUDGET: what is said of that budget.
expect() {
    local status=0 said
    printf '%s\n' "$3" >budget
    said=$("$script" . budget <deps) || status=$?
    if [ "$status" != "$1" ] || ! grep -qF "$2" <<<"$said"; then
        printf 'budget "%s": status %s, and it says\n%s\nwanted: %s and "%s"\n' "$3" "$status" "$said" "$1" "$2"
        exit 1
    fi
}
expect 0 'all rooms: 4500 lines' 'core/room 5'
expect 1 'core/room reads 4500 lines, and 4000 are granted; the most are those of large.hpp (4000)' 'core/room 4'
expect 1 "core/room has no line in $PWD/budget; it reads 4500 lines" "# nothing"
expect 1 "core/gone is in $PWD/budget, and nothing of it was compiled" $'core/room 5\ncore/gone 1'
: >deps
expect 1 'build first' 'core/room 5'
