#!/bin/sh
# A scene renders to a picture, and nothing that may not change it does so by one byte. The kernel
# made for it is smaller than the one with every effect, which traces the same rays, and none of a
# kind that the scene does not call for.
#     scene_test.sh WHIT PICTURE_CHECK SCENE [WHAT]
# WHAT: "validated", under GPU-assisted validation only; "levels", each level of numerics for itself.
set -eu
whit=$1
check=$2
scene=$3
what=${4:-}
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

fail() {
    echo "FAILED  $*"
    exit 1
}

# render NAME OPTION...: NAME.pfm, which holds pixels only, NAME.exr, identities, with a recipe that is
# the same for the same pixels, and NAME.json, what it took.
render() {
    name=$1
    shift
    "$whit" render "$scene" -o "$folder/$name.pfm" --ids "$folder/$name.exr" --size 64x48 --quiet \
        --stats json "$@" >"$folder/$name.json" 2>"$folder/stderr" || {
        code=$?
        cat "$folder/stderr"
        fail "whit render $scene $*: exit code $code"
    }
    [ ! -s "$folder/stderr" ] || {
        cat "$folder/stderr"
        fail "whit render --quiet $scene $*: was not quiet"
    }
}

same() {
    render other "$@"
    cmp "$folder/first.pfm" "$folder/other.pfm" || fail "$* gives the same picture"
    echo "ok      $* gives the same picture"
}

# figure NAME KEY: of NAME.json
figure() {
    sed -n "s/^ *\"$2\": \([0-9]*\),*\$/\1/p" "$folder/$1.json"
}

# The kernel with every effect beside the one that `first` was drawn with.
all_effects() {
    same --effects all "$@"
    cmp "$folder/first.exr" "$folder/other.exr" || fail "--effects all gives the same identities"
    own=$(figure first instructions)
    all=$(figure other instructions)
    [ "$own" -lt "$all" ] || fail "$own instructions of $all are fewer"
    "$whit" scene "$scene" --json |
        awk -F'"' '$2 == "name" { name = $4 } $2 == "called" && /true/ { print name }' >"$folder/called"
    for kind in shadow:shadows reflected:reflection refracted:refraction; do
        key=${kind%:*}
        rays=$(figure other "$key")
        [ "$(figure first "$key")" = "$rays" ] || fail "--effects all traces as many $key rays"
        [ "$rays" -eq 0 ] || grep -qx "${kind#*:}" "$folder/called" ||
            fail "no ray is $key where the scene does not call for it"
    done
    echo "ok      $own of $all instructions trace the same rays"
}

case $what in
levels)
    for level in fast exact; do
        render first --numerics $level
        all_effects --numerics $level
    done
    exit 0
    ;;
esac
render first
"$check" "$folder/first.pfm" 64 48
if [ "$what" = validated ]; then
    WHIT_VALIDATION=1
    export WHIT_VALIDATION
    same --effects auto
    exit 0
fi
# Each thread of the driver's and of whit's own, over tiles that are larger and smaller than needed.
for way in 0:16 1:17 2:32; do
    LP_NUM_THREADS=${way%:*}
    export LP_NUM_THREADS
    same --tile "${way#*:}" --threads $((LP_NUM_THREADS + 1))
done
unset LP_NUM_THREADS
same --tile 512
same --load-path storage
same --load-path texel
same --build median
all_effects
