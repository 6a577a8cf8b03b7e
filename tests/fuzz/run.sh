#!/bin/sh
# Builds the fuzz targets with Clang and runs each of them under libFuzzer, two at a time:
#     tests/fuzz/run.sh FOLDER SECONDS [TARGET...]
# FOLDER keeps the build, the corpora and what is found: a finding is FOLDER/found-TARGET-*, and the
# exit code is not 0. Logs: FOLDER/TARGET.log.
set -eu
root=$(cd "$(dirname "$0")/../.." && pwd)
folder=$1
seconds=$2
shift 2
[ $# -gt 0 ] || set -- obj mtl gltf ply scene image texture reply rays validate store paths \
    settings report view
mkdir -p "$folder"
folder=$(cd "$folder" && pwd)
probe='#include <stddef.h>
int LLVMFuzzerTestOneInput(const char *data, size_t size);
int LLVMFuzzerTestOneInput(const char *data, size_t size) { return data && size ? 0 : 0; }'
if ! printf '%s\n' "$probe" |
    clang -x c -fsanitize=fuzzer,address,undefined -o "$folder/probe" - >/dev/null 2>&1; then
    echo "SKIPPED: no clang with libFuzzer (Debian 12: apt-get install clang libclang-rt-14-dev)"
    exit 0
fi
cd "$root"
cmake --preset fuzz -B "$folder/build" >"$folder/build.log" 2>&1 &&
    cmake --build "$folder/build" --target fuzzers >>"$folder/build.log" 2>&1 || {
    tail -n 40 "$folder/build.log"
    exit 1
}

# run_one TARGET: its own corpus first, then the seeds; those that are there.
run_one() {
    target=$1
    mkdir -p "$folder/$target"
    set -- "$folder/$target"
    for seeds in seeds/$target found/$target; do
        [ ! -d "tests/fuzz/$seeds" ] || set -- "$@" "tests/fuzz/$seeds"
    done
    for seeds in seeds/$target corpus/$target; do
        [ ! -d "$folder/build/tests/fuzz/$seeds" ] || set -- "$@" "$folder/build/tests/fuzz/$seeds"
    done
    [ "$target" != scene ] || set -- "$@" scenes
    [ ! -f "tests/fuzz/$target.dict" ] || set -- "-dict=tests/fuzz/$target.dict" "$@"
    "$folder/build/tests/fuzz/fuzz_$target" -max_total_time="$seconds" -max_len=4096 \
        -seed=1 -rss_limit_mb=2048 -timeout=10 -print_final_stats=1 \
        -artifact_prefix="$folder/found-$target-" "$@" >"$folder/$target.log" 2>&1
}

summary() {
    printf '%-9s %s executions, %s\n' "$1" \
        "$(sed -n 's/^stat::number_of_executed_units: *//p' "$folder/$1.log")" \
        "$(sed -n 's/.*\(cov: [0-9]* ft: [0-9]*\).*/\1/p' "$folder/$1.log" | tail -n 1)"
}

failed=0
while [ $# -gt 0 ]; do
    first=$1
    second=${2-}
    run_one "$first" &
    job=$!
    if [ -n "$second" ]; then
        run_one "$second" || failed=1
        shift
    fi
    wait "$job" || failed=1
    shift
    for target in $first $second; do
        summary "$target"
        grep -h -E '^fuzz:|runtime error|^SUMMARY|^artifact_prefix' "$folder/$target.log" || :
    done
done
exit "$failed"
