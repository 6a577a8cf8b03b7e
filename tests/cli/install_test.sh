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

# The shared library: whit_* and no other name, and a program by pkg-config.
library=$(find "$OUT/prefix" -name 'libwhit.so')
nm -D --defined-only "$library" | awk '{ print $3 }' >"$OUT/names"
if grep -v '^whit_' "$OUT/names"; then
    echo "FAILED  libwhit.so exports more than whit_*"
    exit 1
fi
for name in $(grep -ohE '\bwhit_[a-z_]+\(' "$OUT"/prefix/include/whit/*.h | tr -d '(' | sort -u); do
    grep -qx "$name" "$OUT/names" && continue
    case $(grep -hE "(typedef|define|inline).*\b$name\b" "$OUT"/prefix/include/whit/*.h) in '') ;; *) continue ;; esac
    echo "FAILED  libwhit.so lacks $name"
    exit 1
done
echo "ok      libwhit.so exports $(grep -c . "$OUT/names") names, all of whit.h"
if command -v pkg-config >/dev/null && [ -z "${CFLAGS_EXTRA:-}" ]; then
    PKG_CONFIG_PATH=$(dirname "$library")/pkgconfig
    export PKG_CONFIG_PATH
    # shellcheck disable=SC2046
    "${CC:-cc}" -std=c11 "$SOURCE/tests/example/example.c" -o "$OUT/by_pkg_config" \
        $(pkg-config --cflags --libs whit) -lm
    LD_LIBRARY_PATH=$(dirname "$library") "$OUT/by_pkg_config" "$SOURCE/scenes/cube.json" "$OUT/shared.png"
    cmp "$OUT/cube.png" "$OUT/shared.png"
    echo "ok      the example by pkg-config and the shared library: the same picture"
fi
for file in LICENSE CHANGELOG.md docs/cli.md; do
    test -s "$OUT/prefix/share/doc/whit/$file" || { echo "FAILED  $file is not installed"; exit 1; }
done
"$OUT/prefix/bin/whit" --version
