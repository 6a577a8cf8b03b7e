#!/bin/sh
# Runs the folder of tools/gpu-report in a file system that has nothing else but lavapipe, like a machine that has only
# the driver of a GPU.
. "$(dirname "$0")/common.sh"
needs jq
ROOT=$(cd "$(dirname "$0")/../.." && pwd)
TEST_DRIVER=${VK_DRIVER_FILES:-}
[ -n "$TEST_DRIVER" ] || { echo "SKIPPED: these are not the tests of lavapipe"; exit 77; }
[ "$(id -u)" -eq 0 ] || { echo "SKIPPED: chroot needs root"; exit 77; }
[ -x /bin/busybox ] || { echo "SKIPPED: no busybox-static"; exit 77; }

REPORT=$OUT/gpu-report
check "the folder is made" env -u WHIT_VALIDATION -u WHIT_POISON -u LD_PRELOAD "$ROOT/tools/gpu-report" "$REPORT" >"$OUT/made.txt" 2>&1
cat "$OUT/made.txt" | tail -n 3
glibc=$(objdump -T "$ROOT/build/report/whit" | grep -o 'GLIBC_[0-9.]*' | sort -uV | tail -n 1)
check "no library needs a later glibc than whit ($glibc)" test "GLIBC_$(cut -d ' ' -f 1 "$REPORT/glibc.txt")" = "$glibc"
xzcat "$REPORT/programs.tar.xz" | tar -t >"$OUT/programs"
check "it has what a container may lack of NVIDIA's driver" grep -q '^lib/libXext.so.6$' "$OUT/programs"
check "at most 60 MiB" test "$(du -sk "$REPORT" | cut -f 1)" -le $((60 * 1024))

BARE=$OUT/bare
mkdir -p "$BARE/dev" "$BARE/proc" "$BARE/tmp" "$BARE/usr/share/vulkan/icd.d"
put() {
    mkdir -p "$BARE$(dirname "$1")"
    cp -L "$1" "$BARE$1"
}
library=$(sed -n 's/.*"library_path": *"\([^"]*\)".*/\1/p' "$TEST_DRIVER")
case $library in /*) ;; *) library=$(ldconfig -p | awk -v name="$library" '$1 == name { print $NF; exit }') ;; esac
for file in "$library" /lib64/ld-linux-x86-64.so.2 /lib/x86_64-linux-gnu/libdl.so.2 /lib/x86_64-linux-gnu/libpthread.so.0 \
    /lib/x86_64-linux-gnu/librt.so.1 $(ldd "$library" | awk '$2 == "=>" { print $3 }'); do
    put "$file"
done
cp "$TEST_DRIVER" "$BARE/usr/share/vulkan/icd.d/"
mv "$REPORT" "$BARE/report"
{ mknod "$BARE/dev/null" c 1 3 && chmod 666 "$BARE/dev/null" && mknod "$BARE/dev/urandom" c 1 9; } ||
    { echo "SKIPPED: no devices may be made"; exit 77; }
mount -t proc proc "$BARE/proc" || { echo "SKIPPED: no proc may be mounted"; exit 77; }
trap 'umount "$BARE/proc" && rm -rf --one-file-system "$OUT"' EXIT
bare_run() {
    env -i "$(command -v chroot || echo /usr/sbin/chroot)" "$BARE" /report/bin/busybox sh /report/run "$@" >"$OUT/run.txt" 2>&1
}
bare_run /none gone
check "a device that is not there: exit code 3" test $? -eq 3
check "which is said" grep -q 'no device .gone.' "$BARE/none/report.txt"
start=$(date +%s)
bare_run /out
status=$?
took=$(($(date +%s) - start))
cat "$OUT/run.txt"
check "it ends (exit code $status)" test "$status" -eq 0
check "within 8 minutes ($took s)" test "$took" -le 480
files=$(find "$BARE/out" -type f | wc -l)
check "at most 8 files, and all of them ($files)" test "$files" -le 8 -a "$files" -ge 8
check "at most 16 MiB" test "$(du -sk "$BARE/out" | cut -f 1)" -le $((16 * 1024))
for file in devices check kernels hard rays frame; do
    check "$file.json is JSON" jq -e . "$BARE/out/$file.json" >"$OUT/stdout"
done
rows=$(wc -l <"$BARE/report/hits.txt")
check "every bit of every hit is lavapipe's ($rows rows)" \
    test "$(grep -Ec '^[a-z0-9]+-(camera|shadow|bounce)[a-z-]* +(watertight|exact) +[0-9]+ +0 +0$' "$BARE/out/report.txt")" -eq "$rows"
pictures=$(ls "$BARE/report/pictures" | grep -vc -- -ids)
check "every picture is ($pictures)" \
    test "$(grep -Ec '^[a-z0-9-]+ +(watertight|exact) +\(?0 +0 +0 +\(?0$' "$BARE/out/report.txt")" -eq "$pictures"
cases=$("$WHIT" check "$ROOT/tests/check/whit.suite" --root "$ROOT" --list | wc -l)
check "so is every case of whit's own suite ($cases)" \
    jq -e --argjson all "$cases" '[.cases[] | select(.verdict == "ok")] | length == $all' "$BARE/out/check.json"
check "whit hard keeps its promises" jq -e '.broken == 0' "$BARE/out/hard.json" >"$OUT/stdout"
finish
