#!/bin/sh
# The installed library, used by a project of its own: sh install_test.sh CMAKE BUILD SOURCE
set -eu
CMAKE=$1
BUILD=$2
SOURCE=$3
OUT=$(mktemp -d)
trap 'rm -rf "$OUT"' EXIT
"$CMAKE" --install "$BUILD" --prefix "$OUT/prefix" >"$OUT/log" 2>&1 || { cat "$OUT/log"; exit 1; }
headers=$(cd "$SOURCE/host" && ls api/whit*.h base/whit_base.h)
for file in bin/whit $(echo "$headers" | sed 's,.*/,include/whit/,'); do
    test -s "$OUT/prefix/$file" || { echo "FAILED  $file is not installed"; exit 1; }
    echo "ok      $file is installed"
done
"$CMAKE" -S "$SOURCE/tests/example" -B "$OUT/build" -DCMAKE_PREFIX_PATH="$OUT/prefix" \
    ${CFLAGS_EXTRA:+"-DCMAKE_C_FLAGS=$CFLAGS_EXTRA"} >"$OUT/log" 2>&1 &&
    "$CMAKE" --build "$OUT/build" >>"$OUT/log" 2>&1 || { cat "$OUT/log"; exit 1; }
echo "ok      find_package(whit) and the example build"
"$OUT/build/example" "$SOURCE/scenes/cube.json" "$OUT/cube.png"
test -s "$OUT/cube.png"
echo "ok      the example rendered a picture and traced rays"
"$OUT/prefix/bin/whit" --version
