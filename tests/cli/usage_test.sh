#!/bin/sh
# Usage errors and bad files give exit code 2 and one line that names the error; no file is left behind, and no device
# is opened.
. "$(dirname "$0")/common.sh"
VK_DRIVER_FILES=/nonexistent
VK_ICD_FILENAMES=/nonexistent
export VK_DRIVER_FILES VK_ICD_FILENAMES
mkdir "$OUT/pictures"
P=$OUT/pictures/x.png

shows "help" "^  render " --help
for command in $("$WHIT" --complete | cut -f 1); do
    shows "$command --help" "^usage: whit $command" "$command" --help
done
expect 0 "version" --version
check "version is a number" grep -Eq '^whit [0-9]+\.[0-9]+\.[0-9]+$' "$OUT/stdout"

expect 2 "no arguments"
check "no arguments: usage on stderr" grep -q "^usage: whit" "$OUT/stderr"
refuse 2 "unknown command" "there is no command or file .paint." paint
refuse 2 "misspelt command" "did you mean .whit render." rendre
refuse 2 "unknown option of the program" "there is no option .--paint." --paint

refuse 2 "no scene" "a scene is missing" render -o "$P"
refuse 2 "two scenes" "too many" render "$CUBE" "$CUBE" -o "$P"
refuse 2 "no output" "-o FILE is missing" render "$CUBE"
refuse 2 "unknown option" "whit render --help" render "$CUBE" -o "$P" --paint
refuse 2 "misspelt option" "did you mean .--camera." render "$CUBE" -o "$P" --camrea 1
refuse 2 "value missing" "needs a value" render "$CUBE" -o "$P" --size
refuse 2 "value not wanted" "takes no value" render "$CUBE" -o "$P" --quiet=yes
refuse 2 "a letter of two bytes" 'there is no option `-.xc3`' render "$CUBE" -o "$P" -é
refuse 2 "too long a name of functions" "FILE: 400 bytes are too long" shader "$(printf '%0400d' 0)"
for size in 0x10 10x0 10 x 10x10x10 -5x5 99999x10 10x 1e2x10; do
    refuse 2 "--size $size" "WxH" render "$CUBE" -o "$P" --size "$size"
done
refuse 2 "--size 30000x30000" "900000000 pixels are more than 268435456" \
    render "$CUBE" -o "$P" --size 30000x30000
for samples in 0 4097 -1 4x four ""; do
    refuse 2 "--aa '$samples'" "a whole number from 1 to 4096 or adaptive:X" render "$CUBE" -o "$P" --aa "$samples"
done
refuse 2 "--depth -1" "whole number" render "$CUBE" -o "$P" --depth -1
refuse 2 "--tile-size 5" "from 16 to 1024" render "$CUBE" -o "$P" --tile-size 5
refuse 2 "--tile 32" "\`--tile-size\` now" render "$CUBE" -o "$P" --tile 32
refuse 2 "--packets some" "auto, on, off" render "$CUBE" -o "$P" --packets some
refuse 2 "--time nan" "a number from" render "$CUBE" -o "$P" --time nan
refuse 2 "--build best" "binned, sweep" render "$CUBE" -o "$P" --build best
refuse 2 "--build binned:1" "from 2 to 256" render "$CUBE" -o "$P" --build binned:1
for build in binned: binned:257 binned:7x median:3 sweep:2 spatial: spatial:2 spatial:1e-5, \
    spatial:1e-5,-1 spatial:1e-5,1,1 none+opt +opt binned+opt+opt binned+opt:7 ""; do
    refuse 2 "--build '$build'" "need\|take numbers\|nothing to improve" render "$CUBE" -o "$P" --build "$build"
done

# Removed options in the table of CHANGELOG.md: each option of the first column is refused with an error that names an
# option of the second column, or says `is gone` where that column says `nothing`.
awk -F ' *[|] *' '/^[|] / {
    rest = $3
    named = $3 ~ /^nothing/ ? "is gone" : ""
    while (match(rest, /`--[^`]*`/)) {
        option = substr(rest, RSTART + 1, RLENGTH - 2)
        sub(/ [A-Z].*/, "", option) # its argument
        named = named (named == "" ? "" : "\\|") ".*`" option "`"
        rest = substr(rest, RSTART + RLENGTH)
    }
    count = split($2, parts, /, |; /)
    for (i = 1; i <= count; ++i)
        if (parts[i] ~ /^`(whit [a-z ]+)?--[^`]*`$/) print substr(parts[i], 2, length(parts[i]) - 2) "\t" named
}' "$(dirname "$0")/../../CHANGELOG.md" >"$OUT/gone"
check "options that are gone are found ($(wc -l <"$OUT/gone"))" test "$(wc -l <"$OUT/gone")" -ge 12
while IFS="$(printf '\t')" read -r option named; do
    # shellcheck disable=SC2086
    set -- $(echo "$option" | sed 's/^--/whit render &/;s/ N$/ 4/')
    shift
    "$WHIT" "$1" --help >"$OUT/help" 2>&1 || continue # built without the viewer
    refuse 2 "$option, which is gone" "$named" "$@"
done <"$OUT/gone"
refuse 2 "--build none with --leaf" "no leaves" render "$CUBE" -o "$P" --build none --leaf 2
refuse 2 "--leaf 16" "from 1 to 15" render "$CUBE" -o "$P" --leaf 16
refuse 2 "--leaf 0" "from 1 to 15" render "$CUBE" -o "$P" --leaf 0
refuse 2 "--time and --frame" "two ways" render "$CUBE" -o "$P" --time 1 --frame 2

refuse 2 "unknown extension" "x.gif: pictures are" render "$CUBE" -o "$OUT/pictures/x.gif"
refuse 2 "identities as PNG" "ids.png: hit identities are .exr" render "$CUBE" -o "$P" --ids "$OUT/ids.png"
refuse 2 "--thumbnail of costs" "one picture of colours" render "$CUBE" -o "$P" --thumbnail 64 --view visits
refuse 2 "--thumbnail 0" "from 1 to 4096" render "$CUBE" -o "$P" --thumbnail 0
refuse 2 "--thumbnail with --size" "leave out --size" render "$CUBE" -o "$P" --thumbnail 64 --size 200x100
refuse 2 "a dash as picture" "-o -: pictures go to files" render "$CUBE" -o -
refuse 2 "a dash as identities" "--ids -: " render "$CUBE" -o "$P" --ids -
refuse 2 "a dash as rays" "--input -: .*/dev/stdin" trace "$CUBE" --input - -o "$OUT/pictures/h"
refuse 2 "a dash as hits" "-o -: .*/dev/stdout" trace "$CUBE" --input "$CUBE" -o -
refuse 2 "a dash as triangles" "--triangles -: .*/dev/stdout" scene "$CUBE" --triangles -
refuse 2 "no such folder" "nowhere/x.png" render "$CUBE" -o "$OUT/nowhere/x.png"
refuse 2 "missing scene" "missing.json" render "$OUT/missing.json" -o "$P"
refuse 2 "folder as scene" "$OUT: this is a folder" render "$OUT" -o "$P"
: >"$OUT/dot."
refuse 2 "name that ends in a dot" "$OUT/dot.: its name has no known extension" render "$OUT/dot." -o "$P"
printf '{ "objects": [\n  oops ] }\n' >"$OUT/broken.json"
refuse 2 "broken scene names its line" "broken.json:2" render "$OUT/broken.json" -o "$P"
printf '{ "materials": {\n  "a": { "texture": "no.png" } } }\n' >"$OUT/bare.json"
refuse 2 "missing texture" "bare.json:2:10: materials.a.texture" render "$OUT/bare.json" -o "$P"
refuse 2 "unknown camera" "there is no camera .front." render "$CUBE" -o "$P" --camera front
refuse 2 "misspelt camera" "did you mean .camera." render "$CUBE" -o "$P" --camera camrea
refuse 2 "camera number too large" "there is no camera .7." render "$CUBE" -o "$P" --camera 7
refuse 2 "nine numbers" "there is no camera" render "$CUBE" -o "$P" --camera 0,0,5,0,0,0,0,1,0
refuse 2 "camera without length" "same point" \
    render "$CUBE" -o "$P" --camera 0,0,0,0,0,0,0,1,0,40
refuse 2 "angle of 180 degrees" "between 0 and 180" \
    render "$CUBE" -o "$P" --camera 0,0,5,0,0,0,0,1,0,180

refuse 2 "trace without rays" "--input FILE is missing" trace "$CUBE" -o "$OUT/pictures/hits"
refuse 2 "devices with an argument" "too many" devices "$CUBE"

# In the same environment commands that need a device fail.
refuse 3 "no driver: render" "Vulkan" render "$CUBE" -o "$P"
refuse 3 "no driver: devices" "Vulkan" devices
check "no empty line comes first" test -n "$(head -n 1 "$OUT/stdout")"
check "no file was left" is_empty "$OUT/pictures"
finish
