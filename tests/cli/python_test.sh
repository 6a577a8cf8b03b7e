#!/bin/sh
# whit.py against the headers and the program, pytest_whit.py against a suite: sh python_test.sh WHIT SCENES CC LIBRARY
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

# A suite as tests of pytest.
cd "$OUT" || exit 1
cp "$SCENES"/../tests/example_check/looks.* .
awk -f "$SCENES/../tests/example_check/bracket.awk" >bracket.stl </dev/null
# says CODE WHAT PATTERN COMMAND...: the command ends with CODE, and says PATTERN.
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
