#!/bin/sh
# A project that has its part checked by an installed whit, by ctest: sh example_check_test.sh WHIT SCENES CMAKE BUILD
. "$(dirname "$0")/common.sh"
CMAKE=$3
BUILD=$4
CTEST=$(dirname "$CMAKE")/ctest
SOURCE=$SCENES/..
cd "$OUT" || exit 1
check "it installs" "$CMAKE" --install "$BUILD" --prefix "$OUT/prefix" >stderr 2>&1
cp -r "$SOURCE/tests/example_check" part
# with TEXT COMMAND...: it ends with 0, and says TEXT; without TEXT COMMAND...: with another, and says so too.
with() {
    text=$1
    shift
    "$@" >stderr 2>&1 && grep -q -e "$text" stderr
}
without() {
    text=$1
    shift
    ! "$@" >stderr 2>&1 && grep -q -e "$text" stderr
}
configure() {
    "$CMAKE" -S part -B "$@" -DCMAKE_PREFIX_PATH="$OUT/prefix"
}
tests() {
    "$CTEST" --test-dir build --output-on-failure --no-tests=error "$@"
}
check "the example is configured" with "" configure build
check "all cases pass" with "100% tests passed, 0 tests failed out of 3" tests
for name in looks.front-watertight looks.front-exact looks.side; do
    check "$name is one" grep -q " $name \.* *Passed" stderr
done


no_device="env VK_DRIVER_FILES=/nonexistent VK_ICD_FILENAMES=/nonexistent"
# shellcheck disable=SC2086
check "without a device a case fails" without "0% tests passed, 1 tests failed out of 1" $no_device \
    "$CTEST" --test-dir build --output-on-failure -R side
check "and says why" grep -q "whit: error: .*no Vulkan driver" stderr

# Another part, and another suite: the next build takes them over.
echo 'under bracket.stl --size 160x120 --camera 140,-60,30,25,18,-18,0,1,0,30' >>part/looks.whit
check "the suite is listed anew" with "Configuring done" "$CMAKE" --build build
sed -i 's/box(5, 18, 5, 25, 22, 30)/box(5, 18, 5, 25, 22, 31)/' part/bracket.awk
check "the part is made anew" with "Configuring done" "$CMAKE" --build build
check "a millimetre more, and a case more: all fail" without "0% tests passed, 4 tests failed out of 4" tests
check "three differ" test "$(grep -c ": differs: colours other, and what pixels hit" stderr)" -eq 3
check "one is new" grep -q "^under: no golden" stderr

# What cannot be listed.
echo 'lost nowhere.stl' >>part/looks.whit
check "a suite that is wrong" without "looks.whit:6: the scene .nowhere.stl.: there is no such file" configure build
sed -i '$d' part/looks.whit
sed -i 's/ROOT/ROUTE/' part/CMakeLists.txt
check "no keyword" without "ROUTE;.*: no keyword" configure build
finish
