#!/bin/sh
# The viewer and files: scenes that come, go and are mended, pictures and lines that go out, replays.
. "$(dirname "$0")/common.sh"
. "$(dirname "$0")/view_common.sh"
mkdir "$OUT/work"
cd "$OUT/work" || exit 1
SMALL="--size 96x64"

# ---- Scenes ----

mkdir list
cp "$CUBE" list/a.json
cp "$SCENES/8k.json" list/b.json
cp "$SCENES/spin.json" list/c.json
echo no scene >list/notes.txt
# shellcheck disable=SC2086
play "scenes by arrows" list/a.json $SMALL <<END
still
state a
press Right
still
state b
press Right
still
state c
press Right
still
state around
press Left
still
state back
drop $SCENES/cube.json
still
state dropped
drop $OUT/nowhere.json
still
state nowhere
drop list/b.json
still
state mended
END
is a scene list/a.json
is b scene list/b.json
is c scene list/c.json
is around scene list/a.json
is back scene list/c.json
is dropped scene "$SCENES/cube.json"
differs frame.ids a b
same frame.ids a around
same frame.ids c back
same frame.ids a dropped
same frame.ids dropped nowhere
check "a scene that is not there is said" test "$(value nowhere error | grep -c nowhere.json)" -eq 1
is mended error ""
same frame.ids b mended

# Read again: an error with file and line, the old picture stays; then its mend.
cp "$CUBE" own.json
sed 's/"size": 1,/"size": 2,/' "$CUBE" >larger.json
sed 's/"shape": "box"/"shape": "boxx"/' "$CUBE" >broken.json
line=$(grep -n boxx broken.json | cut -d : -f 1)
mkfifo "$OUT/pipe"
cat >"$OUT/replay" <<END
still
state start
move 40 30
button left down
move 45 30
button left up
still
state turned
until toast = own.json was written: reading it again
until error
press R
still
state broken
await larger
press R
still
state mended
END
timeout $((100 * ${WHIT_TEST_PATIENCE:-1})) "$WHIT" view own.json --size 96x64 \
    --replay "$OUT/replay" --quiet >"$OUT/pipe" 2>"$OUT/stderr" &
viewer=$!
while read -r state; do
    echo "$state" >>"$OUT/read"
    case $state in
    *'"at":"turned"'*) mv broken.json own.json ;;
    *'"at":"broken"'*) mv larger.json own.json && touch larger ;;
    esac
done <"$OUT/pipe"
wait $viewer
check "read again: exit code 0" test $? -eq 0
check "read again: nothing to complain of" test ! -s "$OUT/stderr"
mv "$OUT/read" "$OUT/states"
read_states
check "the error has file and line" test "$(value broken error | grep -c "own.json:$line:")" -eq 1
same frame.ids turned broken
same frame.pixels turned broken
is mended error ""
differs frame.ids turned mended
same words turned mended

# ---- Out: the picture, and the line that makes it ----

# shellcheck disable=SC2086
play "pictures" "$SCENES/spin.json" $SMALL --fps 10 <<END
press F2
press F2
still
press V
still
press F12
state costs
press B
still
move 40 30
button left down
move 49 33
button left up
press T
press M
press Minus
press A
press K
press Period
still
press Ctrl+C
press F12
still
wait 4200
still
shot shown.png
state shown
END
check "F12 saves" test -s whit-0001.png
check "Ctrl+C copies the line" test "$(value shown frame.whole)" = true
value shown render | sed -e 's/^whit //' -e 's/picture.png$/rendered.png/' >"$OUT/line"
check "the line has all that was switched" sh -c "grep -q -e --camera '$OUT/line' &&
    grep -q -e '--traversal sign' '$OUT/line' && grep -q -e '--numerics exact' '$OUT/line' &&
    grep -q -e '--build sweep' '$OUT/line' && grep -q -e '--aa 4' '$OUT/line' &&
    grep -q -e '--depth 7' '$OUT/line' && grep -q -e '--time 0.1' '$OUT/line'"
eval "run $(cat "$OUT/line") --quiet"
check "the line renders (got $status)" test "$status" -eq 0
check "byte for byte the window's picture" cmp whit-0001.png rendered.png
expect 0 "what the window showed" compare shown.png rendered.png --tolerance 0 --metric largest
check "its recipe is inside" grep -aq "whit render .*spin.json" whit-0001.png
check "costs are not saved so" test ! -e whit-0002.png
check "and it says how" test "$(value costs toast | grep -c 'whit render --view')" -eq 1

# The words of a start are those of the state: whit view says as whit render does.
# shellcheck disable=SC2086
play "words" "$SCENES/whitted.json" $SMALL --traversal basic --build median --aa 4 --depth 3 \
    --bailout 0.01 --fresnel schlick --opaque-shadows --instances off --numerics fast <<END
still
state start
END
renders start -o words.pfm --ids words.exr
is start words "--size 96x64 --traversal basic --numerics fast --build median --instances off --aa 4 --depth 3 --bailout 0.01 --fresnel schlick --opaque-shadows"
# shellcheck disable=SC2086
play "costs" "$SCENES/default.json" $SMALL --view visits --view-rays all --view-scale 64 <<END
press F2
press F2
still
state start
END
is start words "--size 96x64 --view visits --view-rays all --view-scale 64"
is start frame.view visits

# ---- Replays ----

bad() { # TEXT: refused, with file and line
    printf 'still\n# a comment\n\n%s\n' "$1" >bad.replay
    refuse 2 "\`$1\`" "bad.replay:4: .*no event of a replay" view "$CUBE" --replay bad.replay
}
for text in "jump" "until" "await" "choose" "clock" "clock false" "key T" "key T sideways" "press Hyper+T" "press" "move 1" "click 1" "wheel" \
    "size 10" "size x y" "wait -1" "wait soon" "button none down" "char x" "shot" "drop"; do
    bad "$text"
done
refuse 2 "no replay" "nowhere.replay" view "$CUBE" --replay nowhere.replay
refuse 2 "no place for a record" "nowhere/record" view "$CUBE" --record nowhere/record --frames 1
finish
