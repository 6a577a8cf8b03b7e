#!/bin/sh
# A scene renders to a picture, and nothing that may not change it does so by one byte.
#     scene_test.sh WHIT PICTURE_CHECK SCENE
set -eu
whit=$1
check=$2
scene=$3
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

# render NAME OPTION...: PFM and EXR of integers, which hold pixels only or the same recipe.
render() {
    name=$1
    shift
    "$whit" render "$scene" -o "$folder/$name.pfm" --size 96x72 --quiet "$@" 2>"$folder/stderr" || {
        echo "whit render $scene $*: exit code $?"
        cat "$folder/stderr"
        exit 1
    }
    if [ -s "$folder/stderr" ]; then
        echo "whit render --quiet $scene $*: was not quiet"
        cat "$folder/stderr"
        exit 1
    fi
}

same() {
    render other "$@"
    cmp "$folder/first.pfm" "$folder/other.pfm" || { echo "changes the picture: $*"; exit 1; }
    echo "same bytes: $*"
}

render first
"$check" "$folder/first.pfm" 96 72
for tile in 16 17 64 512; do
    same --tile $tile
done
for threads in 0 1 2; do
    LP_NUM_THREADS=$threads
    export LP_NUM_THREADS
    same --threads $((threads + 1))
done
unset LP_NUM_THREADS
same --load-path storage
same --load-path texel
same --build median
same --effects all
WHIT_VALIDATION=1
export WHIT_VALIDATION
same --effects auto
