#!/bin/sh
# Compares whit.py with the headers and the program, and pytest_whit.py with a suite.
#     sh python_test.sh WHIT SCENES CC LIBRARY
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
cd "$OUT" || exit 1
awk -f "$SCENES/../tests/example_check/bracket.awk" >part.stl </dev/null
sed -n '/^```python$/,/^```$/p' "$SCENES/../docs/check.md" | grep -v '^```' >doc.py
check "the lines of the docs" "$PYTHON" doc.py

# The installed whit.py loads the library of its own prefix.
mkdir -p prefix/share/whit/python prefix/lib/any && cp "$PYTHONPATH"/*.py prefix/share/whit/python
ln -s "$WHIT_LIBRARY" prefix/lib/any/libwhit.so.0.2
found() {
    env -u WHIT_LIBRARY PYTHONPATH=prefix/share/whit/python "$PYTHON" -c \
        'import whit, sys; sys.exit(whit._library._name != sys.argv[1])' "$OUT/prefix/lib/any/libwhit.so.0.2" 2>stderr
}
check "the library of the same prefix is taken" found
sed -i 's/^VERSION = .*/VERSION = "9.9.0"/' prefix/share/whit/python/whit.py
refused() {
    ! PYTHONPATH=prefix/share/whit/python "$PYTHON" -c 'import whit' 2>stderr
}
check "a library of another version is not" refused
check "which is said" grep -q "^ImportError: .*/whit.py is for libwhit 9.9.0, and .* is [0-9.]*$" stderr

# The cases of a suite are tests of pytest.
cp "$SCENES"/../tests/example_check/looks.* .
mv part.stl bracket.stl
# says CODE WHAT PATTERN COMMAND...: the command ends with CODE, and prints a line with PATTERN.
says() {
    code=$1 what=$2 pattern=$3
    shift 3
    "$@" >stderr 2>&1
    check "$what: exit code $code (got $?)" test $? -eq "$code"
    check "$what: says \`$pattern\`" grep -q -e "$pattern" stderr
}
suite() {
    "$PYTHON" -m pytest -p pytest_whit -p no:cacheprovider -v "$@"
}
says 0 "a suite" "3 passed" suite
says 0 "one case" "looks.whit::side PASSED" suite looks.whit::side
says 0 "further options" "1 passed" suite looks.whit::side --whit-options="--root '$OUT'"
says 1 "no device" "^exit code 3: no device" \
    env VK_DRIVER_FILES=/nonexistent VK_ICD_FILENAMES=/nonexistent "$PYTHON" -m pytest -p pytest_whit -q looks.whit::side
check "what whit says of it" grep -q "^whit: error: no Vulkan driver" stderr
sed -i '/^side/s/30$/31/' looks.whit
says 1 "another view" "^side: differs: colours other, and what pixels hit" suite looks.whit::side
check "how to repeat it" grep -qx "again: $WHIT check $OUT/looks.whit --only side" stderr
echo bad >>looks.whit
says 2 "a suite that is wrong" "^whit: error: .*/looks.whit:5: .bad. alone" suite
check "in whit's words alone" test "$(grep -c Traceback stderr)" -eq 0
says 2 "no program" "^/nowhere cannot be run: No such file or directory" suite --whit /nowhere
finish
