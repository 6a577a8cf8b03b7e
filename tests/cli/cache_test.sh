#!/bin/sh
# Files that whit keeps from one run to the next change no figure and hang no run when they are damaged, replaced or in
# the wrong place. The third argument is whit with clocks of its own, so that figures are comparable.
. "$(dirname "$0")/common.sh"
needs jq
RIGHT=$WHIT
WHIT=$3
XDG_CACHE_HOME=$OUT/cache
export XDG_CACHE_HOME
mkdir "$OUT/cache" "$OUT/true"
KEPT=$OUT/cache/whit
VICTIM=$OUT/victim
unset WHIT_VALIDATION # the layers keep a file of their own
unset MESA_SHADER_CACHE_DIR MESA_SHADER_CACHE_DISABLE MESA_SHADER_CACHE_MAX_SIZE

# price WHAT OPTION...: the figures of `whit cost` are the same, whether they were measured or read from the cache.
price() {
    how=$1
    shift
    expect 0 "$how" cost "$CUBE" --size 32x24 --quick --rays 0 --spend 0.1 --quiet --reference-samples 4 \
        --knobs shadows --json "$OUT/now.json" "$@"
    jq -S '[.rows[] | {error, alone, price: (.price | del(.device))}]' "$OUT/now.json" >"$OUT/now"
    [ -f "$OUT/figures" ] || cp "$OUT/now" "$OUT/figures"
    check "$how: the same figures" cmp -s "$OUT/figures" "$OUT/now"
}

cached() {
    check "$how: references are $1" test "$(jq .reference.cached "$OUT/now.json")" = "$2"
}

replace_all() {
    for name in $names; do
        rm -rf "${KEPT:?}/$name"
        "$@" "$KEPT/$name"
    done
}

price "without a cache" --no-cache
check "nothing is kept, by Mesa neither" is_empty "$OUT/cache"
price "with an empty one"
cached "made" false
names=$(cd "$KEPT" && echo reference-*)
check "two references and pipelines are kept" test "$(printf '%s\n' "$KEPT"/reference-* \
    "$KEPT"/pipelines-* | grep -vc '[*]')" -ge 3
check "for this user alone" test -z "$(find "$KEPT" -maxdepth 1 -perm /077)"
check "and Mesa's beside them" test -n "$(find "$KEPT" -path '*/mesa-*-0*/*' -type f)"
price "with a full one"
cached "kept" true
cp -p "$KEPT"/reference-* "$OUT/true"

for name in $names; do # from the pixels on
    size=$(wc -c <"$KEPT/$name")
    dd if=/dev/zero of="$KEPT/$name" bs=24 seek=1 count=$((size / 24 - 1)) conv=notrunc 2>"$OUT/dd"
done
price "zeroed pixels"
cached "made" false
replace_all mkfifo -m 600
price "pipes in their place"
cached "made" false
echo "not to be touched" >"$VICTIM"
chmod 600 "$VICTIM"
replace_all ln -s "$VICTIM"
price "links in their place"
cached "made" false
check "where they lead nothing is touched" test "$(cat "$VICTIM")" = "not to be touched"
for name in $names; do
    check "the links are gone, what is kept is right" cmp -s "$KEPT/$name" "$OUT/true/$name"
    check "and no link" test ! -L "$KEPT/$name"
done

chmod 777 "$KEPT"
WHIT=$RIGHT
ls -A "$KEPT" >"$OUT/before"
expect 0 "a folder that others may write to" render "$CUBE" -o "$OUT/a.png" --size 16x16 --quiet
check "is not used" test "$(ls -A "$KEPT")" = "$(cat "$OUT/before")"
check "which is said once" test "$(grep -c "others may write to it: nothing is kept there" \
    "$OUT/stderr")$(wc -l <"$OUT/stderr")" = 11
run devices --json
check "devices: where, and why not" test "$(jq -r '.cache | .folder + ": " + .why_not' \
    "$OUT/stdout")" = "$KEPT: others may write to it"
chmod 755 "$KEPT"
run devices --json
check "devices: how large" jq -e --argjson size "$(find "$KEPT" -maxdepth 1 -type f -printf '%s\n' |
    jq -s add)" '.cache | .why_not == null and .used_bytes == $size and .limit_bytes == 536870912 and
    .mesa_used_bytes > 0 and .mesa_limit == "128M"' "$OUT/stdout"
check "others cannot look into it any more" test -z "$(find "$KEPT" -maxdepth 0 -perm /077)"
# The file about a device's floats is read by the next run. If it is damaged, or has the text of another file, the
# device is tested again.
floats=$(echo "$KEPT"/floats-*)
found='[.devices[] | select(.kind == "cpu") | .floats] == [{own_division: true, own_comparison: true, keeps_denormals: true, rounds_nearest: true}]'
check "devices: floats" jq -e "$found" "$OUT/stdout"
cp "$floats" "$OUT/floats"
# anew WHAT YES|NO: whether `whit devices` writes the file again, with the same bytes. The old file stays open
# meanwhile, so that a new one cannot get its inode number.
anew() {
    touch -d 2001-01-01 "$floats"
    before=$(stat -c %i "$floats")
    exec 9<"$floats"
    run devices --json
    exec 9<&-
    check "$1: floats" jq -e "$found" "$OUT/stdout"
    check "$1: found out anew: $2" test "$([ "$(stat -c %i "$floats")" = "$before" ] && echo no || echo yes)" = "$2"
    check "$1: the file" cmp "$floats" "$OUT/floats"
    check "$1: counts as new" test -z "$(find "$floats" -mtime +1)"
}
anew "kept" no
printf '\0' | dd of="$floats" bs=1 seek=24 conv=notrunc 2>"$OUT/dd"
anew "damaged" yes
cp "$(echo "$KEPT"/reference-* | cut -d ' ' -f 1)" "$floats"
anew "another file in its place" yes
WHIT_CACHE_LIMIT=0 run devices
check "floats as text" grep -qx "     portable  pictures, division by itself, comparison by itself" "$OUT/stdout"
check "the same as text" grep -q "^cache  $KEPT: 0.[0-9] of 0 MiB" "$OUT/stdout"

# ---- Mesa's cache, by driver version and vector width ----

# mesa_folder VARIABLE=VALUE...: prints the folder that whit gives to Mesa.
mesa_folder() {
    env "$@" "$WHIT" devices --json | jq -r .cache.mesa_folder
}
own=$(mesa_folder A=B)
check "this width has a folder" test "$own" != "$(mesa_folder LP_NATIVE_VECTOR_WIDTH=128)"
check "that does not change" test "$own" = "$(mesa_folder A=B)"
check "code that is not optimized has one of its own" \
    test "$(mesa_folder GALLIVM_PERF=nopt)" = "$(mesa_folder GALLIVM_PERF=)nopt"
mkdir "$OUT/drivers"
echo '{}' >"$OUT/a.json"
echo '{}' >"$OUT/drivers/b.json"
touch -d 2001-01-01 "$OUT/drivers/b.json"
check "so has a driver" test "$(mesa_folder VK_ADD_DRIVER_FILES="$OUT/a.json")" != "$own"
before=$(mesa_folder VK_ADD_DRIVER_FILES="$OUT/a.json:$OUT/drivers")
touch -d 2002-01-01 "$OUT/drivers/b.json"
check "and each version of it" \
    test "$(mesa_folder VK_ADD_DRIVER_FILES="$OUT/a.json:$OUT/drivers")" != "$before"
folders() {
    find "$KEPT" -maxdepth 1 -name 'mesa-*' | wc -l
}
check "none goes that may be in use ($(folders))" test "$(folders)" -gt 4
find "$KEPT" -maxdepth 1 -name 'mesa-*' -exec touch -d '2 hours ago' {} +
mesa_folder A=B >"$OUT/again"
check "of older ones four are kept" test "$(folders)" -eq 4
check "the one in use among them" test -d "$own"
MESA_SHADER_CACHE_DIR=$OUT/mine run devices --json
check "what the user says stays" jq -e --arg mine "$OUT/mine" \
    '.cache.mesa_folder == $mine and .cache.mesa_limit == null' "$OUT/stdout"

# ---- Kernels that a second device translates ----

# beside WHAT NUMBER OPTION...: a second device translates NUMBER kernels for the picture; `some`: one or more; `any`:
# any number, because on a busy machine a kernel from the cache can take as long as one that is translated. Code is
# optimized, so that even the smallest kernel takes long enough to be told apart.
beside() {
    how=$1
    wanted=$2
    shift 2
    GALLIVM_PERF='' XDG_CACHE_HOME=$OUT/second run render "$CUBE" -o "$OUT/$how.pfm" --size 16x16 --quiet --stats json "$@"
    got=$(jq .kernel.translated_beside "$OUT/stdout")
    [ "$wanted" = any ] ||
        check "$how: $wanted kernels by a second device ($got)" test "$([ "$got" -gt 0 ] && echo some || echo 0)" = "$wanted"
    check "$how: the same picture" cmp -s "$OUT/empty.pfm" "$OUT/$how.pfm"
}
mkdir "$OUT/second"
some=$([ "$(nproc)" -lt 2 ] && echo 0 || echo some)
beside empty "$some"
beside full any
beside part "$some" --traversal basic # the smallest kernels, which trace no rays, are in the cache
beside none 0 --no-cache

# ---- No place at all ----

# quiet_without WHAT COMMAND...: COMMAND sets the environment; in it whit draws a picture and prints nothing.
quiet_without() {
    how=$1
    shift
    "$@" "$WHIT" render "$CUBE" -o "$OUT/a.png" --size 16x16 --quiet 2>"$OUT/stderr"
    check "$how: exit code 0" test $? -eq 0
    check "$how: nothing is said" test ! -s "$OUT/stderr"
}
quiet_without "neither HOME nor XDG_CACHE_HOME" env -u HOME -u XDG_CACHE_HOME
quiet_without "a folder that cannot be made" env XDG_CACHE_HOME=/proc/nowhere
finish
