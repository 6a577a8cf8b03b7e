#!/bin/sh
# Makefiles, which CMake writes where no generator is named: sh makefiles_test.sh WHIT SCENES CMAKE. Kernels are built, and
# built again when a file changes that they include. Ninja builds whit for all other tests.
. "$(dirname "$0")/common.sh"
needs make
CMAKE=$3
BUILD=$OUT/build
SOURCE=$(cd "$SCENES/.." && pwd)
unset MAKEFLAGS MFLAGS CMAKE_GENERATOR
quietly() {
    "$@" >"$OUT/stdout" 2>"$OUT/stderr"
}
# rebuilt ARGUMENT...: the kernels that make would compile.
rebuilt() {
    make -C "$BUILD" -n -f shaders/CMakeFiles/whit_kernels.dir/build.make "$@" shaders/CMakeFiles/whit_kernels.dir/build |
        sed -n 's/.*--depfile \([^ ]*\) .*/\1/p' | sort
}
check "CMake writes Makefiles" quietly "$CMAKE" -S "$SOURCE" -B "$BUILD" -DWHIT_TESTS=OFF
check "that is its own choice" test -f "$BUILD/Makefile"
check "make builds the kernels" quietly make -C "$BUILD" -j 2 whit_kernels
check "make reads what each of them includes" quietly make -C "$BUILD" whit_kernels
check "make has nothing left to build" test -z "$(rebuilt)"
packet=$SOURCE/shaders/bind/packet.glsl
grep -l "bind/packet.glsl" "$BUILD"/shaders/spirv/*.d | sort >"$OUT/include_it"
check "$(wc -l <"$OUT/include_it") kernels include packets" test -s "$OUT/include_it"
rebuilt -W "$packet" >"$OUT/rebuilt"
check "a change of packets compiles these and no others" cmp "$OUT/include_it" "$OUT/rebuilt"
finish
