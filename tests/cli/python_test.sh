#!/bin/sh
# whit.py against the headers and the program: sh python_test.sh WHIT SCENES CC LIBRARY
. "$(dirname "$0")/common.sh"
CC=$3
TESTS=$(cd "$(dirname "$0")/../python" && pwd)
export WHIT SCENES WHIT_LIBRARY="$4" WHIT_SCENES="$SCENES" PYTHONDONTWRITEBYTECODE=1
export PYTHONPATH="$SCENES/../host/api/python"
for PYTHON in python3 /usr/bin/python3 ''; do
    [ -n "$PYTHON" ] || { echo "SKIPPED: no pytest (Debian: python3-pytest)" && exit 77; }
    "$PYTHON" -c 'import pytest' 2>"$OUT/stderr" && break
done
layout() {
    "$PYTHON" "$TESTS/layout.py" "$SCENES"/../host/whit/*.h >"$OUT/layout.c" 2>"$OUT/stderr" &&
        "$CC" -std=c11 -Wall -Werror -I "$SCENES/../host" "$OUT/layout.c" -o "$OUT/layout" 2>"$OUT/stderr" && "$OUT/layout"
}
check "structs, enumerators and prototypes of whit.py are those of whit.h" layout
check "pictures, rays and errors" "$PYTHON" -m pytest -q -p no:cacheprovider "$TESTS/whit_test.py"
finish
