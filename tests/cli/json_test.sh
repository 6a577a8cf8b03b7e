#!/bin/sh
# docs/cli.md promises that keys of JSON are added, never renamed or removed. json_keys.txt lists the keys of every
# document; a new key is added there.
. "$(dirname "$0")/common.sh"
needs jq
HERE=$(cd "$(dirname "$0")" && pwd)
KEYS=$HERE/json_keys.txt
cd "$OUT" || exit 1
SMALL="--size 16x12 --quiet"

# keys NAME FILE: adds the paths of the keys of the file, without indices of lists, to $OUT/found.
keys() {
    jq -r --arg name "$1" '[paths | map(select(type == "string")) | join(".")] | unique[] |
        select(. != "") | "\($name) \(.)"' "$2" >>"$OUT/found" || FAILED=1
}
# made NAME ARGUMENT...: adds the keys of the JSON that whit prints.
made() {
    name=$1
    shift
    expect 0 "$name" "$@"
    keys "$name" "$OUT/stdout"
}
# saved NAME ARGUMENT...: adds the keys of the file that whit writes with --json.
saved() {
    name=$1
    shift
    rm -f made.json
    expect 0 "$name" "$@" --json made.json
    keys "$name" made.json
    check "$name: format 2" jq -e '.format == 2 and (.whit | test("^[0-9.]+$"))' made.json
}

: >found
# shellcheck disable=SC2086
{
    made render render "$SCENES/gallery/glass.json" -o p.png $SMALL --stats json --counters
    made render render "$CUBE" -o p.png $SMALL --stats json --refine 1
    made render render "$CUBE" -o p.png $SMALL --stats json --aa adaptive:0.05
    grep -a -o '{"width":[^}]*}' p.png >options && keys whit:options options
    grep -a -o '{"rays":{[^}]*}[^}]*}' p.png >counters && keys whit:counters counters
    made render render "$CUBE" -o costs.png $SMALL --view visits --quiet
    grep -a -o '{"view":[^}]*}' costs.png >view && keys whit:view view
    expect 0 "a part" render "$CUBE" -o part.exr $SMALL --tile 1/1
    made merge merge part.exr -o merged.exr --stats json
    echo "$CUBE -o line.png $SMALL" >lines
    made batch batch lines --stats json --quiet
    made frames render "$SCENES/spin.json" -o p.##.png --frames 0-1 $SMALL --stats json
    made scene scene "$SCENES/default.json" --json
    # Effects that a shader does not ask for are not compiled, and the JSON says so.
    echo 'vec3 shade(Surface s, Optics o, vec3 to_eye) { return s.ns; }' >plain.glsl
    made effects scene "$CUBE" --effects --json --size 16x12 --quiet --shader plain.glsl
    check "no shadows are asked for" jq -e 'any(.effects[]; .name == "shadows" and .called and (.asked or .compiled | not))' \
        "$OUT/stdout"
    check "each effect has the same keys" \
        jq -e '(.effects | length > 0) and ([.effects[] | keys] | unique | length == 1)' "$OUT/stdout"
    made kernels scene "$CUBE" --kernels --json --size 16x12 --quiet
    saved probe probe "$SCENES/gallery/glass.json" --pixel 8,6 $SMALL
    echo 'vec3 miss(vec3 dir) { return dbg(dir); }' >dbg.glsl
    saved probe probe "$CUBE" --pixel 0,0 $SMALL --shader dbg.glsl
    made bvh bvh "$CUBE" --json --runs 1 --rays 500 --build binned --threads 1 --quiet
    saved hard hard --case sphere --quick --quiet --numerics watertight
    saved compare compare p.png p.png
    cat >all.glsl <<'END'
//@ whit 1
//@ slider bands 1 8 3 "steps of light"
//@ choice mode plain,warm
//@ aov facing
//@ expect ids == base
vec4 facing(Surface s) { return vec4(-dot(s.ns, ray_dir())); }
vec3 post(ivec2 at, vec3 color) { return color * bands; }
//@ test
void bright(uint seed) { check(bands > 0.0); }
END
    made shader shader all.glsl --json
    saved cost cost "$CUBE" $SMALL --spend 0.2 --rays 100 --knobs traversal --within 1e6
    cp "$CUBE" cube.json && echo "cube cube.json --size 16x12" >looks.whit
    expect 0 "a golden" check looks.whit --accept all
    saved check check looks.whit
    made devices devices --json
    absent=
    if [ -x "$(dirname "$WHIT")/whit-bench" ]; then
        saved bench bench build "$CUBE" --quick --runs 1 --scenes "$SCENES"
    else
        absent="bench"
    fi
    # States of the viewer: one picture, two side by side, and their difference. Names of clickable items, keys and
    # effects are left out.
    if "$WHIT" --help | grep -q "^  view " && command -v Xvfb >xvfb; then
        printf '%s\n' still 'click 24 18' still 'state a' 'press I' still 'state b' 'press U' still 'state c' >replay
        sh "$HERE/display.sh" "$WHIT" view "$CUBE" --size 48x36 --aa 4 --shader dbg.glsl --replay replay --quiet \
            >states 2>"$OUT/stderr"
        check "the viewer's states are written" test "$(grep -c '^{.*}$' states)" -eq 3
        jq 'del((.items, .keys, .panels, .cut_panels, .prices, .effect_prices)[])' states >state && keys state state
    else
        absent="$absent state"
    fi
}
# The driver chooses the names of its figures of kernels. Documents of parts that are not built have no keys here.
sort -u found | grep -v '^kernels kernels\.driver\.' >have
# A row for each choice of the braces.
awk 'function expand(row, first, rest, choices, count, i) {
        if (!match(row, /[{][^}]*[}]/)) {
            print row
            return
        }
        first = substr(row, 1, RSTART - 1)
        rest = substr(row, RSTART + RLENGTH)
        count = split(substr(row, RSTART + 1, RLENGTH - 2), choices, ",")
        for (i = 1; i <= count; ++i)
            expand(first choices[i] rest)
    }
    !/^#/ { expand($0) }' "$KEYS" >rows
awk -v absent=" $absent " 'index(absent, " " $1 " ") == 0 { at = $2 == ".:" ? "" : substr($2, 1, length($2) - 1) "."
    for (i = 3; i <= NF; ++i) print $1, at $i }' rows | sort -u >want
comm -13 have want >gone
comm -23 have want >new
check "no key is gone: $(tr '\n' ',' <gone)" test ! -s gone
check "every key is in json_keys.txt, new: $(head -20 new | tr '\n' ',')" test ! -s new

# Words in backquotes, which may be broken by the end of a line.
for page in cli batch shaders view; do
    tr '\n' ' ' <"$HERE/../../docs/$page.md" | tr '`' '\n' | awk 'NR % 2 == 0'
done | tr -c 'a-z0-9_' '\n' | sort -u >told
awk '{ for (i = 3; i <= NF; ++i) print $i }' rows | sort -u | comm -23 - told >untold
check "every key is in the docs, not: $(tr '\n' ',' <untold)" test ! -s untold
finish
