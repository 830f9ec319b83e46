#!/usr/bin/env bash
# formatted.sh CLANG_FORMAT SOURCES: fails where a file of the project is not laid out as .clang-format says.
set -euo pipefail
cd "$2"
find bench core examples lua nodes tests tools transport \( -name '*.cpp' -o -name '*.hpp' \) -print0 |
    xargs -0 -n 100 "$1" --dry-run -Werror
