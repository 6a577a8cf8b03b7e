#!/bin/sh
# Another project uses the installed library: sh install_test.sh WHIT SCENES CMAKE BUILD
. "$(dirname "$0")/common.sh"
CMAKE=$3
BUILD=$4
SOURCE=$SCENES/..
quietly() {
    "$@" >"$OUT/stderr" 2>&1
}
check "it installs" quietly "$CMAKE" --install "$BUILD" --prefix "$OUT/prefix"
cd "$OUT/prefix" || exit 1
for file in bin/whit $(cd "$SOURCE/host" && ls whit/*.h | grep -v whit_program | sed 's,^,include/,') \
    share/doc/whit/LICENSE share/doc/whit/CHANGELOG.md share/doc/whit/docs/cli.md \
    share/whit/python/whit.py share/whit/python/pytest_whit.py share/doc/whit/examples/example_check/check.yml \
    share/man/man1/whit.1 share/man/man1/whit-render.1 share/bash-completion/completions/whit \
    share/zsh/site-functions/_whit share/fish/vendor_completions.d/whit.fish; do
    check "$file is installed" test -s "$file"
done
build_example() {
    "$CMAKE" -S "$SOURCE/tests/example" -B "$OUT/build" -DCMAKE_PREFIX_PATH="$OUT/prefix" \
        ${CFLAGS_EXTRA:+"-DCMAKE_C_FLAGS=$CFLAGS_EXTRA"} && "$CMAKE" --build "$OUT/build"
}
check "find_package(whit) and the example build" quietly build_example
check "the example renders a picture and traces rays" "$OUT/build/example" "$CUBE" "$OUT/cube.png"
check "the picture is there" test -s "$OUT/cube.png"

# The shared library needs no package of what it stands on.
mkdir "$OUT/shared"
cat >"$OUT/shared/CMakeLists.txt" <<'END'
cmake_minimum_required(VERSION 3.16)
project(shared LANGUAGES NONE)
foreach(package Threads Vulkan assimp glslang SPIRV-Tools-opt PNG JPEG OpenEXR PkgConfig)
  set(CMAKE_DISABLE_FIND_PACKAGE_${package} ON)
endforeach()
find_package(whit REQUIRED CONFIG COMPONENTS shared)
find_package(whit REQUIRED CONFIG COMPONENTS check shared)
if(NOT TARGET whit::whit_shared)
  message(FATAL_ERROR "no target")
endif()
END
check "find_package(whit COMPONENTS shared)" quietly "$CMAKE" -S "$OUT/shared" -B "$OUT/shared/build" \
    -Dwhit_DIR="$(dirname "$(find "$OUT/prefix" -name whitConfig.cmake)")"

# The libraries export whit_* and no other name, and a program is built with it by pkg-config.
library=$(find "$OUT/prefix" -name 'libwhit.so')
nm -D --defined-only --extern-only "$library" | awk '{ print $3 }' >"$OUT/names"
check "libwhit.so exports nothing but whit_*" test "$(grep -vc '^whit_' "$OUT/names")" -eq 0
nm --defined-only --extern-only "$(find "$OUT/prefix" -name 'libwhit.a')" | awk '$3 { print $3 }' >"$OUT/archive"
if grep -q "^WHIT_GNU_LD:.*NOTFOUND$" "$BUILD/CMakeCache.txt"; then
    echo "skipped  names of libwhit.a: there is no linker of GNU"
else
    check "nor does libwhit.a" test -s "$OUT/archive" -a "$(grep -vc '^whit_' "$OUT/archive")" -eq 0
fi
# declared HEADER...: prints the functions that the headers declare.
declared() {
    grep -ohE '\bwhit_[a-z_]+\(' "$@" | tr -d '(' | sort -u
}
missing=
for name in $(declared include/whit/*.h); do
    grep -qx "$name" "$OUT/names" || grep -qhE "(typedef|define|inline).*\b$name\b" include/whit/*.h ||
        missing="$missing $name"
done
check "libwhit.so exports $(grep -c . "$OUT/names") names, all of whit.h$missing" test -z "$missing"
declared "$SOURCE/host/whit/whit_program.h" >"$OUT/own"
declared include/whit/*.h >"$OUT/public"
check "and none that is for whit's own programs" \
    test -s "$OUT/own" -a -z "$(comm -23 "$OUT/own" "$OUT/public" | grep -xFf - "$OUT/names")"
# A sanitizer's library has to come before libc, so the program links it too.
sanitize=
grep -q "^WHIT_SANITIZE:.*=ON$" "$BUILD/CMakeCache.txt" && sanitize=-fsanitize=address,undefined
by_pkg_config() {
    # shellcheck disable=SC2046
    "${CC:-cc}" -std=c11 $sanitize "$SOURCE/tests/example/example.c" -o "$OUT/by_pkg_config" \
        $(PKG_CONFIG_PATH=$(dirname "$library")/pkgconfig pkg-config --cflags --libs whit) -lm &&
        LD_LIBRARY_PATH=$(dirname "$library") "$OUT/by_pkg_config" "$CUBE" "$OUT/shared.png"
}
if command -v pkg-config >/dev/null && [ -z "${CFLAGS_EXTRA:-}" ]; then
    check "the example by pkg-config and the shared library" quietly by_pkg_config
    check "the same picture" cmp "$OUT/cube.png" "$OUT/shared.png"
    check "where Python finds it" test -s \
        "$(PKG_CONFIG_PATH=$(dirname "$library")/pkgconfig pkg-config --variable=pythondir whit)/whit.py"
fi
# pc DIR=PATH WHAT PATTERN: whit.pc has the line where that folder is absolute, and the others are not.
pc() {
    quietly "$CMAKE" -DPROJECT_BINARY_DIR="$OUT/pc" -DCMAKE_INSTALL_PREFIX=/p -DCMAKE_INSTALL_LIBDIR=lib/x \
        -DCMAKE_INSTALL_INCLUDEDIR=include -DCMAKE_INSTALL_DATADIR=share "-DCMAKE_INSTALL_$1" \
        -P "$SOURCE/host/api/cmake/pkgconfig.cmake"
    shift
    for line; do
        check "whit.pc has $line" grep -qxF "$line" "$OUT/pc/cmake/whit.pc"
    done
}
# shellcheck disable=SC2016
{
    pc LIBDIR=lib 'prefix=${pcfiledir}/../../' 'includedir=${prefix}/include' 'libdir=${prefix}/lib'
    pc LIBDIR=/l 'prefix=/p' 'libdir=/l' 'includedir=${prefix}/include' 'pythondir=${prefix}/share/whit/python'
    pc INCLUDEDIR=/i 'prefix=${pcfiledir}/../../../' 'includedir=/i' 'libdir=${prefix}/lib/x'
    pc DATADIR=/d 'pythondir=/d/whit/python' 'libdir=${prefix}/lib/x'
}
# Debuggers and sanitizers are told where sources are.
if grep -q "^CMAKE_BUILD_TYPE:.*=Release$" "$BUILD/CMakeCache.txt" && [ -z "$sanitize" ]; then
    check "no file names the folder of its sources" \
        test -z "$(find . -type f -exec grep -lF "$(cd "$SOURCE" && pwd)/" {} +)"
fi
check "the installed program runs" bin/whit --version
check "a scene finds its schema" test -s share/whit/scenes/../docs/scene.schema.json
check "a document finds scenes and shaders" test -s share/doc/whit/docs/../scenes/cube.json -a \
    -s share/doc/whit/shaders/examples/toon.glsl
rm share/doc/whit/scenes && mkdir share/doc/whit/scenes && touch share/doc/whit/scenes/mine
check "it installs again beside a folder of that name" quietly "$CMAKE" --install "$BUILD" --prefix "$OUT/prefix"
check "which stays" test -e share/doc/whit/scenes/mine
check "an installed scene has its map" quietly bin/whit scene share/whit/scenes/gallery/normal-map.json

# Files for file managers: each MIME type that they name is known, by whit's own list or by shared-mime-info.
field() {
    sed -n "s/^$2=//p" "$1"
}
THUMBNAILER=share/thumbnailers/whit.thumbnailer
known="model/gltf-binary model/gltf+json model/obj model/stl model/3mf"
known="$known $(sed -n 's/.*<mime-type type="\([^"]*\)".*/\1/p' share/mime/packages/whit.xml)"
types=$(field "$THUMBNAILER" MimeType)
for type in $(echo "$types" | tr ';' ' '); do
    check "$type is known" test "${known#*"$type"}" != "$known"
done
check "nine kinds" test "$(echo "$types" | tr -cd ';' | wc -c)" -eq 9
if [ -s share/applications/whit.desktop ]; then
    check "the viewer opens them" test "$(field share/applications/whit.desktop MimeType)" = "$types"
    check "by name" test "$(field share/applications/whit.desktop Exec)" = "whit view %f"
    check "as an application" test "$(field share/applications/whit.desktop Type)" = Application
    ! command -v desktop-file-validate >/dev/null ||
        check "it is valid" desktop-file-validate share/applications/whit.desktop
fi

# A thumbnail is made as in a sandbox: without display, home and cache, without network where that is possible, and of a
# file with any name.
isolate=
unshare -rn true 2>/dev/null && isolate="unshare -rn"
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n' >"$OUT/a model.obj"
thumbnail() {
    line=$(field "$THUMBNAILER" Exec | sed "s,%i,'$OUT/a model.obj',; s,%o,'$OUT/thumb.X7',; s,%s,$1,g")
    (
        unset DISPLAY WAYLAND_DISPLAY XDG_CACHE_HOME XDG_RUNTIME_DIR MESA_SHADER_CACHE_DIR
        HOME=/proc/self PATH=$OUT/prefix/bin:$PATH $isolate sh -c "$line" >"$OUT/said" 2>&1
    )
}
check "the thumbnailer's line runs" thumbnail 96
check "it says nothing" test ! -s "$OUT/said"
check "a PNG of 96 x 96 pixels" test "$(od -An -tx1 -N8 "$OUT/thumb.X7" | tr -d ' ')$(
    od -An -tx1 -j16 -N8 "$OUT/thumb.X7" | tr -d ' ')" = 89504e470d0a1a0a0000006000000060
printf 'v 0 0\n' >"$OUT/a model.obj"
rm "$OUT/thumb.X7"
thumbnail 96
check "a damaged model: exit code 2" test $? -eq 2
check "and no file" test ! -e "$OUT/thumb.X7"
finish
