#!/usr/bin/env bash
# unique_names.sh BUILD: fails when ctest knows two tests by one name, as it gives both the labels of the second.
set -euo pipefail
twice=$(ctest --test-dir "$1" -N | sed -n 's/^ *Test *#[0-9]*: //p' | sort | uniq -d)
[ -z "$twice" ] || { echo "tests with the same name:"; echo "$twice"; exit 1; }
