#!/bin/sh
# Keeps what run.sh has found to reach new code, and tells how much of each reader that covers:
#     tests/fuzz/keep.sh FOLDER [TARGET...]
# FOLDER is that of run.sh. Of each corpus the inputs that are needed to reach all of its edges go to
# tests/fuzz/corpus/TARGET.tar.gz, which every test run replays.
set -eu
root=$(cd "$(dirname "$0")/../.." && pwd)
folder=$(cd "$1" && pwd)
shift
[ $# -gt 0 ] || set -- obj mtl gltf ply scene image texture reply rays validate store paths \
    settings report view
cd "$root"
mkdir -p tests/fuzz/corpus

# sources TARGET: the files that it is about.
sources() {
    case $1 in
    obj) echo host/load/obj.c host/load/model.c host/load/model_mesh.c ;;
    mtl) echo host/load/mtl.c host/load/mtl_material.c ;;
    gltf) echo host/load/gltf*.c ;;
    ply) echo host/load/ply.c host/load/importer.c ;;
    scene) echo host/load/scene_*.c ;;
    image) echo host/image/png.c host/image/exr.c host/image/pfm.c host/image/hdr.c ;;
    texture) echo host/load/picture.c host/load/jpeg.c ;;
    reply) echo host/image/image_reply.c host/load/importer.c host/base/foreign.c ;;
    rays) echo host/app/trace/ray_file.c host/twin/traverse.c ;;
    validate) echo host/accel/validate*.c ;;
    store) echo host/base/store.c ;;
    paths) echo host/base/roots.c ;;
    settings) echo host/app/view/state_file.c host/app/arguments.c host/settings/*.c ;;
    report) echo host/app/cost/cost_json.c ;;
    view) echo host/view/events.c host/view/remembered_cameras.c ;;
    esac
}

for target in "$@"; do
    rm -rf "$folder/least"
    mkdir -p "$folder/least"
    "$folder/build/tests/fuzz/fuzz_$target" -use_counters=0 -set_cover_merge=1 "$folder/least" \
        "$folder/$target" 2>"$folder/$target.keep.log" >&2
    tar --sort=name --mtime=@0 --owner=0 --group=0 --numeric-owner -C "$folder/least" -cf - . |
        gzip -9n >"tests/fuzz/corpus/$target.tar.gz"
done
rm -rf "$folder/least"

coverage=$folder/coverage
CFLAGS="-fprofile-instr-generate -fcoverage-mapping" CXXFLAGS=$CFLAGS cmake --preset clang \
    -B "$coverage" >"$coverage.log" 2>&1
for target in "$@"; do
    cmake --build "$coverage" --target "fuzz_${target}_replay" fuzz_made_seeds >>"$coverage.log" 2>&1
    program=$coverage/tests/fuzz/fuzz_${target}_replay
    set --
    for seeds in tests/fuzz/seeds/$target tests/fuzz/found/$target \
        "$coverage/tests/fuzz/seeds/$target" "$coverage/tests/fuzz/corpus/$target"; do
        [ ! -d "$seeds" ] || set -- "$@" "$seeds"
    done
    LLVM_PROFILE_FILE=$coverage/$target.raw "$program" "$@" >"$coverage/$target.log" 2>&1
    llvm-profdata-14 merge -o "$coverage/$target.data" "$coverage/$target.raw"
    llvm-cov-14 report "$program" -instr-profile="$coverage/$target.data" |
        awk -v target="$target" -v sources="$(sources "$target")" '
            BEGIN { split(sources, names); for (i in names) wanted[substr(names[i], 6)] = 1 }
            { name = $1; sub(/.*host\//, "", name) }
            name in wanted { lines += $8; missed += $9 }
            END { printf "%-9s lines %d of %d, %.1f %%\n", target, lines - missed, lines,
                100 * (lines - missed) / lines }'
done
