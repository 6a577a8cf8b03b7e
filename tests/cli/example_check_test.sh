#!/bin/sh
# A project whose ctest checks its part by an installed whit; and the lines of docs/check.md and of the recipe for CI.
# Without `whole`, scripts stand in for the installation of packages and for building and installing whit.
#     example_check_test.sh WHIT SCENES CMAKE BUILD [whole]
. "$(dirname "$0")/common.sh"
needs jq
CMAKE=$3
BUILD=$4
CTEST=$(dirname "$CMAKE")/ctest
SOURCE=$SCENES/..
cd "$OUT" || exit 1
check "it installs" "$CMAKE" --install "$BUILD" --prefix "$OUT/prefix" >stderr 2>&1
cp -r "$SOURCE/tests/example_check" part
# with TEXT COMMAND...: the command ends with 0, and prints TEXT if that is not empty.
# without TEXT COMMAND...: the command ends with another exit code, and prints TEXT.
with() {
    text=$1
    shift
    "$@" >stderr 2>&1 </dev/null && { [ -z "$text" ] || grep -q -e "$text" stderr; }
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

# ---- From nothing to a check ----

mkdir -p own/whit/tools hands && cp "$SOURCE/tools/packages" own/whit/tools/ && cp build/bracket.stl own/part.stl
cat >hands/packages <<'PACKAGES'
#!/bin/sh
case "$*" in update) exit 0 ;; install\ *) ;; *) exit 1 ;; esac
shift
for package; do
    case $package in -*) continue ;; esac
    grep -qE "^run +$package( |$)" whit/tools/packages && echo "$package" >>packages || exit 1
done
PACKAGES
cat >hands/cmake <<'BUILT'
#!/bin/sh
case "$*" in
"-S whit -B whit/build -G Ninja -DWHIT_TESTS=OFF" | "--build whit/build" | "--install whit/build"*) echo "$*" >>built ;;
*) exit 1 ;;
esac
BUILT
printf '#!/bin/sh\nexec "$@"\n' >hands/sudo
cp hands/packages hands/apt && cp hands/packages hands/apt-get && chmod +x hands/*
usr=$OUT/prefix opt=$OUT/prefix
if [ "${5:-}" = whole ]; then
    git -C "$SOURCE" ls-files -z | tar -C "$SOURCE" --null -T - -c | tar -C own/whit -x
    rm hands/cmake
    export DESTDIR="$OUT/whole"
    usr=$DESTDIR/usr/local opt=$DESTDIR/opt/whit
fi
# follow FILE: runs the lines of the file one by one; each succeeds, all packages are installed, and whit is built and
# installed once.
follow() {
    rm -f own/packages own/built
    while read -r line; do
        check "$line" with "" env -C own "PATH=$OUT/hands:$usr/bin:$PATH" sh -ec "$line"
    done <"$1"
    check "all packages" test "$(grep -c . own/packages 2>/dev/null)" = "$(grep -c ^run "$SOURCE/tools/packages")"
    check "built and installed" test -n "${DESTDIR:-}" -o "$(grep -c . own/built 2>/dev/null)" = 3
}
awk '/^On Debian 12, / { on = 1 } on && /^    / { print } on && /^    whit check looks.whit$/ { exit }' \
    "$SOURCE/docs/check.md" >lines
check "five lines" test "$(grep -c . lines)" -eq 5
follow lines
check "a green check" grep -qx "part: ok" stderr
sed -n "s/^ *-* run: //p" "$SOURCE/tests/example_check/check.yml" | sed "s,/opt/whit/bin,$opt/bin," >lines
check "three lines in CI" test "$(grep -c . lines)" -eq 3
follow lines
for file in json xml html; do
    check "a report: $file" test -s own/reports/looks.$file
done
check "which is uploaded" grep -q "^        with: {name: looks, path: reports}" "$SOURCE/tests/example_check/check.yml"

# ---- Changes ----

# The next build uses a part and a suite that have changed.
echo 'under bracket.stl --size 160x120 --camera 140,-60,30,25,18,-18,0,1,0,30' >>part/looks.whit
check "the suite is listed anew" with "Configuring done" "$CMAKE" --build build
sed -i 's/box(5, 18, 5, 25, 22, 30)/box(5, 18, 5, 25, 22, 31)/' part/bracket.awk
check "the part is made anew" with "Configuring done" "$CMAKE" --build build
check "a millimetre more, and a case more: all fail" without "0% tests passed, 4 tests failed out of 4" tests
check "three differ" test "$(grep -c ": differs: colours other, and what pixels hit" stderr)" -eq 3
check "one is new" grep -q "^under: no golden" stderr

# Arguments of the CMake function.
sed -i '$s/)$/ PREFIX part- LABELS pictures slow TIMEOUT 77)/' part/CMakeLists.txt
check "a prefix, labels and a time" with "Configuring done" configure build
"$CTEST" --test-dir build --show-only=json-v1 >tests.json
check "are those of each test" jq -e '[.tests[] | [.name, (.properties | map({(.name): .value}) | add | .LABELS, .TIMEOUT)]]
    | length == 4 and .[0] == ["part-front-watertight", ["pictures", "slow"], 77] and all(.[]; .[1:] == [["pictures", "slow"], 77])' tests.json
sed -i '$s/ PREFIX.*/)/' part/CMakeLists.txt

# A suite that is wrong, or names a scene that does not exist.
echo 'lost nowhere.stl --sise 9x9' >>part/looks.whit
check "a suite that is wrong" without "looks.whit:6: .*--sise" configure build
sed -i 's/ --sise 9x9//' part/looks.whit
check "a scene that is made later" with "Configuring done" configure build
check "or never" without "looks.whit:6: the scene .nowhere.stl.: " tests -R lost
sed -i '$d' part/looks.whit
sed -i 's/ROOT/ROUTE/' part/CMakeLists.txt
check "no keyword" without "  no keyword, or one without its value: ROUTE" configure build
finish
