#!/bin/sh
# Tests and measures whit on the GPU of this machine: ./run [FOLDER] [DEVICE]
# Made by whit's tools/gpu-report. Needs an x86-64 Linux with a Vulkan driver and the version of glibc that
# glibc.txt names, and no network. Writes only FOLDER (whit-gpu-report), within 8 minutes:
#     report.txt    all results as text: read this first
#     devices.json check.json kernels.json hard.json rays.json frame.json    figures of single parts
#                   (hard.json: with --portable on)
#     log.txt       errors
# DEVICE: a number or a part of a name, as in `whit render --device` (auto: the best GPU).
set -u
here=$(cd "$(dirname "$0")" && pwd)
out=${1:-whit-gpu-report}
device=${2:-auto}
busybox=$here/bin/busybox
trace_scenes="cube 34k 54k atrium room sphereflake"
kernel_scenes="34k whitted default room"
levels="watertight exact"
for tool in awk basename cat cmp cut date head ls mkdir rm sed sha256sum tail tar timeout wc xzcat; do
    eval "$tool() { \"\$busybox\" $tool \"\$@\"; }"
done
mkdir -p "$out" || exit 2
out=$(cd "$out" && pwd)
for name in devices check kernels hard rays frame; do # of an earlier run
    rm -f "$out/$name.json"
done
scratch=$out/whit-scratch.$$
mkdir -p "$scratch" || exit 2
log=$out/log.txt
report=$out/report.txt
# Keeps the first 4 MB of the log, which drivers may fill, and removes the scratch folder.
finish() {
    if [ "$(wc -c <"$log")" -gt 4000000 ]; then
        head -c 4000000 "$log" >"$scratch/log.txt"
        cat "$scratch/log.txt" >"$log"
    fi
    rm -rf "$scratch"
}
trap finish EXIT
trap 'exit 130' INT TERM
: >"$log"
: >"$report"
begun=$(date +%s)
ends=$((begun + 470))
export XDG_CACHE_HOME="$scratch/cache" TMPDIR="$scratch"
programs=$scratch/programs
mkdir "$programs"
xzcat "$here/programs.tar.xz" | tar -x -f - -C "$programs" || exit 2

say() {
    echo "$*" | "$busybox" tee -a "$report"
}

# whit LIMIT_S ARGUMENT...: runs whit for at most LIMIT_S seconds, and never beyond the end of the whole report.
whit() {
    limit=$1
    shift
    left=$((ends - $(date +%s)))
    [ "$left" -lt "$limit" ] && limit=$left
    if [ "$limit" -le 0 ]; then
        echo "no time left for: whit $*" >>"$log"
        return 124
    fi
    LD_LIBRARY_PATH=$libraries "$busybox" timeout -k 8 "$limit" "$programs/bin/whit" "$@" 2>>"$log"
}

# Uses the machine's own C++ library where whit runs with it: the driver may need a newer one than whit brings.
libraries=$programs/lib
if ! LD_LIBRARY_PATH=$libraries "$programs/bin/whit" --version >/dev/null 2>&1; then
    libraries=$programs/lib:$programs/cxx
fi
if ! version=$(whit 20 --version); then
    say "whit does not run here: it needs glibc $(cat "$here/glibc.txt") or later. What was said:"
    cat "$log"
    exit 1
fi
say "$version, commit $(cat "$here/commit.txt" 2>/dev/null), $(date -u +%Y-%m-%dT%H:%MZ)"

# A container may have the driver, but no manifest where the Vulkan loader looks.
if [ -z "${VK_DRIVER_FILES:-}" ] && ! whit 60 devices --json | "$busybox" grep -q '"kind": "[diov]'; then
    for manifest in /usr/local/nvidia/share/vulkan/icd.d/*.json /opt/*/share/vulkan/icd.d/*.json; do
        [ -f "$manifest" ] || continue
        export VK_DRIVER_FILES="$manifest" VK_ICD_FILENAMES="$manifest"
        say "drivers  $manifest"
        break
    done
fi
say ""
say "== Devices"
whit 60 devices >"$scratch/devices.txt"
code=$?
say "$("$busybox" grep -v '^cache\|^ *Mesa' "$scratch/devices.txt")"
whit 60 devices --json >"$out/devices.json"
if [ "$code" -eq 0 ]; then
    whit 60 render "$here/scenes/cube.json" -o "$scratch/p.exr" --size 16x16 --device "$device" -q
    code=$?
    [ "$code" -eq 3 ] || code=0 # a device that is there, and fails: the parts below say where
fi
if [ "$code" -ne 0 ]; then
    say "There is no device \`$device\` that whit can use (exit code $code):"
    say "$(tail -n 3 "$log")"
    exit 3
fi

say ""
say "== Hits: rays whose hits differ by a bit from lavapipe's"
"$busybox" printf '%-28s %-11s %8s %10s %10s\n' rays numerics rays differing portable | "$busybox" tee -a "$report"
# count_differing NAME NUMERICS HASH PORTABLE: prints how many rays have other hits than on lavapipe, or what failed.
count_differing() {
    scene=$here/scenes/${1%%-*}.json
    rm -f "$scratch/hits" "$scratch/twin"
    if ! whit 30 trace "$scene" --input "$here/rays/$1.rays" -o "$scratch/hits" --numerics "$2" --portable "$4" --device "$device" -q; then
        echo failed
    elif [ "$(sha256sum <"$scratch/hits" | cut -d ' ' -f 1)" = "$3" ]; then
        echo 0
    elif ! whit 60 trace "$scene" --input "$here/rays/$1.rays" -o "$scratch/twin" --numerics "$2" --on cpu -q; then
        echo "some: its twin failed"
    elif [ "$(sha256sum <"$scratch/twin" | cut -d ' ' -f 1)" != "$3" ]; then
        echo "some: its twin differs too"
    else # the twin has lavapipe's bits
        cmp -l "$scratch/twin" "$scratch/hits" | awk '{ ray = int(($1 - 1) / 32); count += ray != last || NR == 1; last = ray } END { print count + 0 }'
    fi
}
while read -r name numerics hash; do
    rays=$(($(wc -c <"$here/rays/$name.rays") / 32))
    "$busybox" printf '%-28s %-11s %8d %10s %10s\n' "$name" "$numerics" "$rays" \
        "$(count_differing "$name" "$numerics" "$hash" off)" "$(count_differing "$name" "$numerics" "$hash" on)" |
        "$busybox" tee -a "$report"
done <"$here/hits.txt"

say ""
say "== Pictures at 320x240 beside lavapipe's: pixels that are not the same, largest difference, FLIP; ids that are not"
"$busybox" printf '%-18s %-11s %8s %12s %12s %6s\n' scene numerics pixels largest flip ids | "$busybox" tee -a "$report"
field() {
    awk -v key="$1" -v column="$2" '$1 == key { gsub(/[(;]/, "", $column); print $column }' "$3"
}
for scene in "$here"/scenes/*.json; do
    name=$(basename "$scene" .json)
    for numerics in $levels; do
        expected=$here/pictures/$name-$numerics
        if ! whit 60 render "$scene" -o "$scratch/p.exr" --ids "$scratch/i.exr" --size 320x240 --numerics "$numerics" --device "$device" -q; then
            say "$name $numerics failed: $(tail -n 1 "$log")"
            continue
        fi
        whit 30 compare "$scratch/p.exr" "$expected.exr" >"$scratch/c.txt"
        whit 30 compare "$scratch/i.exr" "$expected-ids.exr" >"$scratch/i.txt"
        "$busybox" printf '%-18s %-11s %8s %12s %12s %6s\n' "$name" "$numerics" "$(field differing 3 "$scratch/c.txt")" \
            "$(field largest 2 "$scratch/c.txt")" "$(field flip 2 "$scratch/c.txt")" "$(field differing 3 "$scratch/i.txt")" |
            "$busybox" tee -a "$report"
    done
done

say ""
say "== Portable pictures: cases of whit's own suite, each of which is to be the same bytes as lavapipe's"
whit 180 check "$here/whit.suite" --root "$here" --device "$device" --time-limit 150 --json "$out/check.json" -q >"$scratch/check.txt"
say "exit code $?"
say "$(tail -n 12 "$scratch/check.txt")"

say ""
say "== Kernels: registers and the like, where the driver tells them"
echo "[" >"$out/kernels.json"
comma=
for name in $kernel_scenes; do
    for numerics in $levels; do
        echo "$comma" >>"$out/kernels.json"
        whit 60 scene "$here/scenes/$name.json" --kernels --size 1280x720 --numerics "$numerics" --device "$device" --json >"$scratch/k.json" ||
            echo null >"$scratch/k.json"
        cat "$scratch/k.json" >>"$out/kernels.json"
        comma=,
    done
done
echo "]" >>"$out/kernels.json"
whit 60 scene "$here/scenes/default.json" --kernels --size 1280x720 --device "$device" >"$scratch/k.txt"
say "$(cat "$scratch/k.txt")"

say ""
for portable in off on; do
    say "== whit hard --quick --portable $portable"
    whit 120 hard --quick --portable "$portable" --device "$device" --json "$out/hard.json" -q >"$scratch/hard.txt"
    say "exit code $?"
    say "$("$busybox" grep '^promises\|^bits\|^hash\|^all' "$scratch/hard.txt")"
done
say "lavapipe's $("$busybox" grep -o '"hash_met": "[^"]*"' "$here/hard.json")"

# bench NAME LIMIT_S ARGUMENT...: runs a bench; results so far are kept when the time is over.
bench() {
    name=$1
    most=$2
    shift 2
    say ""
    say "== whit bench $name"
    whit "$most" bench "$name" "$@" --scenes "$here/scenes" --device "$device" --json "$out/$name.json" -q >"$scratch/bench.txt"
    code=$?
    say "$(cat "$scratch/bench.txt")"
    return $code
}
bench rays 120 --runs 3
case $? in
0 | 124 | 143) ;; # all rays, or those for which there was time
*)                # a fault of the driver's own ray tracing must not cost the other figures
    say "failed: $(tail -n 1 "$log")"
    rm "$programs/bin/whit-ray-pipeline"
    bench rays 120 --runs 3
    ;;
esac
bench frame 300 34k default whitted room --runs 2
say ""
say "$(($(date +%s) - begun)) s; files: $(ls "$out" | "$busybox" grep -v whit-scratch | "$busybox" tr '\n' ' ')"
