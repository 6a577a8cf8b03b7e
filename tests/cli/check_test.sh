#!/bin/sh
# whit check: verdicts and exit codes, accepted cases and their reasons, bad suites and goldens.
#     sh check_test.sh WHIT SCENES LEAKY
. "$(dirname "$0")/common.sh"
needs jq
LEAKY=$3
cd "$OUT" || exit 1
cp "$SCENES/cube.json" "$SCENES/balls.json" .

cat >looks.whit <<'END'
# two scenes
cube cube.json --size 64x48
balls-{fast,watertight} balls.json --size 64x48 --numerics {}
END
gives 4 "without a golden" "^balls-watertight: no golden$" check looks.whit
check "they are counted" grep -qx "3 cases, 3 new" stdout
check "nothing is written" test ! -e looks.golden
shows "accept one" "^1 case, 1 accepted$" check looks.whit --accept cube
check "a case" test "$(grep -c '^case' looks.golden)" -eq 1
gives 4 "the rest is missing" "^cube: ok$" check looks.whit
expect 0 "accept the rest" check looks.whit --accept balls-fast balls-watertight
shows "all as it was" "^3 cases, 3 ok$" check looks.whit
shows "again, by one and in another order" "^2 cases, 2 ok$" check looks.whit --only balls-watertight --only cube
expect 0 "quiet" check looks.whit -q
check "quiet: the counts alone" test "$(wc -l <stdout)" -eq 1
shows "list" "^balls-fast$" check looks.whit --list
mkdir bare && cp looks.whit bare/
shows "list without the scenes" "^balls-fast$" check bare/looks.whit --list
expect 2 "which are needed to draw" check bare/looks.whit --only cube
check "each is told" grep -q "bare/looks.whit:2: the scene .cube.json.: " stderr
sed -i '1s/.*/whit check golden 2, whit 99.9/' looks.golden
expect 0 "a golden of another whit" check looks.whit

# The picture decides the verdict; a change of the input alone is only reported.
cp looks.golden before
sed -i 's/{"name": "/{ "name": "/' cube.json
printf '\n' >>cube.json
expect 0 "white space in a scene" check looks.whit
sed -i 's/--size 64x48$/--size 64x48 --leaf 2/' looks.whit
shows "another tree" "^cube: input changed, picture same: .cube.json --size 64x48 --leaf 2" check looks.whit
expect 0 "it is accepted without a reason" check looks.whit --accept cube
check "the golden has it" grep -qx "case cube of cube.json --size 64x48 --leaf 2" looks.golden
sed -i 's/--numerics {}/--numerics {} --depth 1/' looks.whit
mkdir ci
expect 1 "fewer bounces" check looks.whit --json ci/report.json --junit ci/junit.xml
check "differs" grep -q "^balls-fast: differs: colours other, of the same hits; rays: .* reflected, were" stdout
check "the counts" grep -qx "3 cases, 1 ok, 2 differs" stdout
cp looks.golden before
check "JSON: what is, and what was" jq -e '.exit_code == 1 and (.cases | length) == 3 and (.cases[1] | .verdict ==
    "differs" and .is.rays.reflected < .was.rays.reflected and .is.ids == .was.ids and .line == 3 and
    (.command | startswith("whit render balls.json --size 64x48 --depth 1 --portable on --numerics fast -o")))' ci/report.json >jq.out
check "JUnit: three cases, two failures" grep -q 'tests="3" failures="2" errors="0"' ci/junit.xml
check "JUnit: why" grep -q 'failure type="differs" message="differs: colours other' ci/junit.xml
mkdir copy && cp cube.json balls.json looks.golden copy/ && sed 's/--depth 1/--depth 2/' looks.whit >copy/looks.whit
cp looks.whit others.whit && sed 's,"looks.whit","other/looks.whit",' ci/report.json >other.json
refuse 2 "a report of another suite" "report.json: a report of the suite looks.whit, not of others.whit" \
    check others.whit --accept-from ci --reason x
refuse 2 "a suite of the same name elsewhere" "other.json: a report of the suite other/looks.whit, not of copy/looks.whit" \
    check copy/looks.whit --accept-from other.json --reason x
refuse 2 "a report of other options" "report.json: balls-fast: it was drawn with other options" \
    check "$PWD/copy/looks.whit" --accept-from ci --reason x
cp looks.whit copy/looks.whit && echo 'balls-fast expect hits < 9' >>copy/looks.whit
refuse 2 "a report of before an expectation" "report.json: balls-fast: the report was made before the suite expected" \
    check copy/looks.whit --accept-from ci --reason x
expect 1 "one that checked it" check copy/looks.whit --json copy/checked.json
gives 1 "what is not as expected in a report" "^1 case, 1 unmet$" check copy/looks.whit --accept-from copy/checked.json --accept balls-fast
jq 'del(.cases[1, 2])' ci/report.json >one.json
refuse 2 "a report without the case" "one.json: it has no result of .balls-f\*. of looks.whit" \
    check looks.whit --accept-from one.json --accept cube 'balls-f*' --reason x
cp looks.whit 's\x1.whit'
expect 4 "a backslash in the name of a suite" check 's\x1.whit' --json backslash.json
expect 0 "its report" check 's\x1.whit' --accept-from backslash.json --accept cube
sed 's/ rays 3072/ rays 9999/' ci/report.json >ci/second.json
refuse 2 "two reports that differ" "second.json: cube: another report says something else" \
    check looks.whit --accept-from ci --reason x
sed -E 's/(case|n) cube (of|ids|parts)/\1 moon \2/g' ci/report.json >moon.json
refuse 2 "lines of another case" "moon.json: cube: its lines of a golden are not those of this one case" \
    check looks.whit --accept-from moon.json --reason x
echo '{' >ci/second.json
refuse 2 "a damaged report" "second.json:[0-9]*: " check looks.whit --accept-from ci --reason x
echo '{}' >ci/second.json
refuse 2 "another file" "second.json: no report of" check looks.whit --accept-from ci --reason x
refuse 2 "no report" "nowhere.json: there is no such file" check looks.whit --accept-from nowhere.json
cp ci/report.json ci/second.json
check "nothing was written" cmp before looks.golden
shows "a report's lines" "^1 case, 1 accepted$" check looks.whit --accept-from ci --only 'balls-w*' --reason "CI has it so"
check "with its reason" grep -qx " balls-watertight why CI has it so" looks.golden
check "the other one stays" test "$(diff before looks.golden | grep -c "^<")" -eq 2
gives 1 "that one is fine" "^3 cases, 2 ok, 1 differs$" check looks.whit
cp before looks.golden
refuse 2 "without a reason" "2 cases are other than the golden: .*--reason TEXT" check looks.whit --accept all
check "nothing is written" cmp before looks.golden
shows "with a reason" "^balls-watertight: differs: " check looks.whit --accept 'balls-*' --reason "two bounces less"
check "it is kept" test "$(grep -c ' why two bounces less$' looks.golden)" -eq 2
expect 0 "as it is now" check looks.whit
refuse 2 "two outputs in one file" "x: --json and --junit name the same file" check looks.whit --json ./x --junit x
refuse 2 "two outputs in one pipe" "--json and --junit name the same file" check looks.whit --json /dev/stdout --junit /dev/stdout
expect 0 "nowhere" check looks.whit --json /dev/null --junit /dev/null
ln looks.golden link
refuse 2 "an output in the golden" "link: the golden and --report name the same file" check looks.whit --report link
rm link
expect 0 "JSON on standard output" check looks.whit --json /dev/stdout
check "is nothing else" jq -e '.cases | length == 3' stdout >jq.out
check "lines for people are on the other" grep -qx "3 cases, 3 ok" stderr
expect 2 "a report that cannot be written" check looks.whit --json nowhere/x --junit junit.xml
expect 2 "a full disk" check looks.whit --json /dev/full --junit junit.xml
check "the next one is" grep -q 'tests="3" failures="0"' junit.xml
refuse 2 "nothing is accepted" "no case is named by both --only and --accept" check looks.whit --only cube --accept 'balls-*'
cp looks.whit looks.suite
refuse 2 "two suites with one golden" "looks.suite has the same golden" check looks.whit --accept all --prune
rm looks.suite

# A golden that cannot be saved: nothing counts as accepted. Of two processes, the second adds to what the first has
# saved.
cp cube.json balls.json copy/
printf 'cube cube.json --size 16x12\nballs balls.json --size 16x12\nbad cube.json --size 16x12 --leaf 2\nbad expect hits == 0\n' \
    >copy/looks.whit
rm copy/looks.golden
expect 1 "nothing to accept" check copy/looks.whit --accept bad
check "begins no golden" test ! -e copy/looks.golden
(ulimit -f 0 && exec "$WHIT" check copy/looks.whit --on reference --accept cube 2>&1) | cat >stdout
check "the error" grep -q "copy/looks.reference.golden: cannot write: " stdout
check "the verdict" grep -qx "1 case, 1 new" stdout
ln -s nowhere/golden copy/looks.golden
refuse 2 "a golden that can never be written" "copy/looks.golden: cannot write: No such file" check copy/looks.whit --accept cube
check "nothing is drawn for it" test ! -s stdout
rm copy/looks.golden
"$WHIT" check copy/looks.whit --accept cube >first 2>&1 &
expect 0 "accepted at once" check copy/looks.whit --accept balls
wait $!
check "both are kept" test "$(grep -c "^case" copy/looks.golden)" -eq 2
check "and no lock" test ! -e copy/looks.golden.lock
mkfifo pipe
(exec "$WHIT" check copy/looks.whit --accept all) >pipe 2>accepted &
exec 3<pipe 3<&-
wait $!
check "nobody reads what it says: SIGPIPE (got $?)" test $? -eq 141
check "and no lock is left" test ! -e copy/looks.golden.lock
expect 0 "once more" check looks.whit --accept all --reason "no reason at all"
check "what is as it was keeps its reason" test "$(grep -c ' why two bounces less$' looks.golden)" -eq 2

# Expectations.
if part 0 2; then
cat >hopes.whit <<'END'
cube cube.json --size 64x48
* expect nonfinite == 0, leaks == 0, max_stack > 0, max_stack <= 24, hits > 100, hits < 3072, rays.primary == 3072
cube expect pixel(32,24).instance == "cube", pixel(0,0).instance == none, pixel(32,24).t > 1, pixel(0,0).primitive != 0
cube expect rays > 3072, rays.cut_by_depth == 0, min >= 0, max < 1, pixel(32,24).material == "cube"
END
cat >rays.whit <<'END'
balls balls.json --size 64x48 --depth 1 --bailout 0.1
balls expect rays.reflected > 200, rays.cut_by_depth > 200, rays.cut_by_bailout > 20, rays.refracted < 200
balls expect rays.reflected < 200, rays.cut_by_depth < 200, rays.cut_by_bailout < 20
END
expect 1 "kinds of rays" check rays.whit
check "each is what it is" grep -qx "balls: no golden; line 3 expects rays.reflected < 200, it is [2-9]..; line 3 expects rays.cut_by_depth < 200, it is [2-9]..; line 3 expects rays.cut_by_bailout < 20, it is 1.." stdout
gives 1 "a number that there is none of" "^cube: no golden; line 3 expects pixel(0,0).primitive != 0, it is none$" check hopes.whit
sed -i 's/, pixel(0,0).primitive != 0//' hopes.whit
expect 0 "all as expected" check hopes.whit --accept all
expect 0 "still" check hopes.whit
mean=$(sed -n 's/.* mean \(.*\)$/\1/p' hopes.golden)
cat >>hopes.whit <<END
cube expect mean within 1e-5 of $mean
cube expect nonfinite > 0, leaks != 0, max_stack > 24, hits == 3072, rays.shadow == 0, max < 0.1 0.1 0.1
cube expect mean within 1e-5 of 0.5, pixel(32,24).instance == none, pixel(0,0).instance == "cube", pixel(32,24) == 0
cube expect pixel(32,24).t < 1, pixel(32,24).material != "cube", rays.refracted > 0
END
expect 1 "nothing as expected" check hopes.whit
check "each is told" test "$(tr ';' '\n' <stdout | grep -c ' expects ')" -eq 13
check "with what is" grep -q "line 7 expects pixel(0,0).instance == \"cube\", it is none" stdout
check "they are no difference" grep -qx "1 case, 1 unmet" stdout
gives 1 "what is not as expected" "^1 case, 1 unmet$" check hopes.whit --accept all
printf 'cube cube.json --size 64x48\ncube expect mean == 9, min == 9, max == 9, pixel(32,24) == 9, pixel(32,24).t == 9\n' >equal.whit
expect 1 "other values" check equal.whit
tr ';' '\n' <stdout | sed -n 's/^ line 2 \(expects .* ==\) 9, it is/cube \1/p' | sed 's/expects/expect/' >values
check "each is told" test "$(wc -l <values)" -eq 5
sed -i 2d equal.whit && cat values >>equal.whit
expect 4 "values as whit prints them are those of the picture" check equal.whit
printf 'cube cube.json --size 16x12\ncube expect leaks == 0\n' >leaks.whit
"$LEAKY" check leaks.whit --accept all >stdout 2>stderr
check "leaks are those of portable kernels" grep -qx "1 case, 1 accepted" stdout
fi

# Bad input.
printf 'a cube.json\nb nowhere.json\nc cube.json -o x.png\n' >bad.whit
expect 2 "two wrong lines" check bad.whit
check "both are told" test "$(grep -c '^whit: error: bad.whit:[23]: ' stderr)" -eq 2
check "nothing is drawn" test ! -s stdout
sed -n 's/^ *REFUSED("\([^"]*\)".*/--\1/p' "$SCENES/../host/app/check/case_options.c" >refused
check "each option that no case may have is in docs/check.md" test "$(wc -l <refused)" -gt 20 -a \
    "$(while read -r option; do grep -qF -- "\`$option\`" "$SCENES/../docs/check.md" || echo "$option"; done <refused)" = ""
refuse 2 "no folder" "root nowhere: there is no such folder" check looks.whit --root nowhere
refuse 2 "no suite" "a suite is missing" check
refuse 2 "no such suite" "nowhere.whit: there is no such file" check nowhere.whit
refuse 2 "no such case" "looks.whit has no such case" check looks.whit --accept cube nothing
refuse 2 "no such pattern" "only .nothing" check looks.whit --only nothing
: >bare/room.glsl && cp cube.json bare/ && printf 'a cube.json\nb cube.json --shader room.glsl\n' >bare/inputs.whit
refuse 2 "a report over a scene" "bare/cube.json: a scene of the suite and --json name the same file" \
    check bare/inputs.whit --json bare/cube.json
refuse 2 "a report over a shader" "bare/room.glsl: a shader of the suite and --junit name the same file" \
    check bare/inputs.whit --junit ./bare/room.glsl
refuse 2 "a report that --list does not write" "list compares nothing" check looks.whit --list --report x.html
refuse 2 "a report that --prune does not write" "prune alone draws nothing, and --junit is" check looks.whit --prune --junit x.xml
refuse 2 "cases for --prune alone" "prune alone draws nothing, and --only is" check looks.whit --prune --only cube
refuse 2 "a revision for reports" "accept-from draws nothing, and --base is" check looks.whit --accept-from ci --base HEAD
refuse 2 "faults of no kind" "seed is of the faults of" check looks.whit --seed 3
refuse 2 "a blank reason" "reason: 1 to 120 bytes, not all blank" check looks.whit --accept all --reason "  "
refuse 2 "a reason alone" "accept is missing" check looks.whit --reason x
refuse 2 "two suites" "one argument too many" check looks.whit looks.whit
echo damaged >>looks.golden
refuse 2 "a damaged golden" "looks.golden:[0-9]*: .damaged.: .case NAME. or" check looks.whit
cp before looks.golden
printf '{ "objects": [\n  oops ] }\n' >broken.json
printf 'fine cube.json --size 64x48 --leaf 2\nbroken broken.json\nlost cube.json --camera nobody\n' >looks.whit
expect 2 "scenes that cannot be drawn" check looks.whit
check "with suite, case, file and line" grep -q "^whit: error: looks.whit:2: broken: .*broken.json:2" stderr
check "a camera that is not there" grep -q "^whit: error: looks.whit:3: lost: .*no camera .nobody" stderr
check "all are counted" grep -qx "3 cases, 1 new, 2 broken" stdout
expect 2 "nor accepted" check looks.whit --accept all
check "the others are" grep -q "^case fine of " looks.golden
for level in 0.5 0.9; do printf 'vec3 post(ivec2 at, vec3 color) { return %s * color; }\n' $level >post-$level.glsl; done
printf '%s cube.json --size 16x12 --shader post-0.5.glsl\n' before behind >functions.whit
sed -i '1a broken broken.json --shader post-0.9.glsl' functions.whit
expect 2 "functions of a case that cannot be drawn" check functions.whit --json functions.json
check "are not those of the next one" jq -e '.cases[0].is.colors == .cases[2].is.colors' functions.json
printf 'mtllib nowhere.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n' >tri.obj
printf 'newmtl a\nmap_Kd nowhere.png\n' >lost.mtl
printf 'mtllib lost.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\n' >lost.obj
echo 'lost lost.obj --size 16x12' >lost.whit
expect 0 "a texture that is missing" check lost.whit --accept all --json lost_report.json
check "is told" grep -qx "lost: no golden; 1 texture cannot be read and is magenta" stdout
check "in reports too" grep -q "accepted: no golden; 1 texture cannot be read" lost_report.json
printf 'one tri.obj --size 16x12\ntwo tri.obj --size 16x12 --depth 0\n' >models.whit
expect 4 "a model without its materials" check models.whit
check "is drawn with a warning, once" test "$(grep -c "^whit: warning: .*nowhere.mtl" stderr)" -eq 1

mkdir -p tree/scenes tree/models && cp tri.obj tree/models/ && cp tri.obj outside.obj
echo '{ "objects": [ { "model": "../models/tri.obj" } ] }' >tree/scenes/tri.json
echo 'tri scenes/tri.json --size 16x12' >tree/looks.whit
expect 0 "a scene that names files elsewhere below the suite's folder" check tree/looks.whit --accept all --json tree.json
again=$(jq -r '.cases[0].command' tree.json)
check "the command that repeats it ($again)" sh -c "\"\$0\" ${again#whit }" "$WHIT"
echo 'tri scenes/tri.json --allow-path ..' >tree/wide.whit
refuse 2 "a folder of its own" "wide.whit:1: option .--allow-path. loosens a limit: .*--root" check tree/wide.whit
expect 0 "below --root" check tree/looks.whit --root tree
sed -i 's,models/tri,../outside,' tree/scenes/tri.json
refuse 2 "one that names files outside of it" "tree/scenes/tri.json:1.*it lies outside of the folder" check tree/looks.whit

# Reports of a run that ends early have the verdicts so far, and `undrawn` for the other cases.
printf 'small cube.json --size 16x12\nlarge cube.json --size 4000x3000 --aa 64\nother cube.json\n' >slow.whit
undrawn() {
    check "JSON: $1" jq -e ".exit_code == $2 and ([.cases[] | .verdict] == $3) and .cases[2].golden == null and
        .cases[2].text == \"not drawn: $4\"" cut/r.json
    check "JUnit: $1" grep -q "<error type=\"undrawn\" message=\"not drawn: $4\"/>" cut/r.xml
    check "page: $1" grep -q "not drawn: $4" cut/r.html
    rm cut/r.xml cut/r.html
}
mkdir cut
set -- check slow.whit --on reference --json cut/r.json --junit cut/r.xml --report cut/r.html
expect 5 "a time limit" "$@" --time-limit 0.3
undrawn "a time limit" 5 '["new", "undrawn", "undrawn"]' "the time limit passed"
check "all are counted" grep -qx "1 case, 1 new, 2 undrawn" stdout
rm stdout # what the run before said is not waited for
"$WHIT" "$@" >stdout 2>stderr &
interrupted $! grep -q "^small: " stdout
check "says how far it came" grep -qx "whit: interrupted, 1 of 3 cases were drawn" stderr
undrawn "Ctrl+C" 130 '["new", "undrawn", "undrawn"]' "the run was interrupted"
# A run that waits until another process has accepted ends as while it draws.
"$WHIT" check slow.whit --on reference --accept all >held 2>&1 &
holder=$!
check "a process that accepts" wait_for $holder test -e slow.reference.golden.lock
set -- "$@" --accept all
expect 5 "a time limit passes meanwhile" "$@" --time-limit 0.1
undrawn "a time limit passes meanwhile" 5 '["undrawn", "undrawn", "undrawn"]' "the time limit passed"
: >stderr # what the run before said is not waited for
"$WHIT" "$@" >stdout 2>stderr &
interrupted $! grep -q "is accepting into it; waiting" stderr
check "says that it drew nothing" grep -qx "whit: interrupted, 0 of 3 cases were drawn" stderr
undrawn "Ctrl+C while it waits" 130 '["undrawn", "undrawn", "undrawn"]' "the run was interrupted"
: >stderr
"$WHIT" check slow.whit --on reference --prune >stdout 2>stderr &
waiting=$!
check "it waits to prune" wait_for $waiting grep -q "is accepting into it; waiting" stderr
kill -TERM $waiting
wait $waiting
check "SIGTERM: exit code 143 (got $?)" test $? -eq 143
check "says that it wrote nothing" grep -qx "whit: interrupted, nothing was written" stderr
kill -INT $holder
wait $holder
expect 5 "a time limit" check slow.whit --on reference --json cut/r.json --time-limit 0.3
gives 1 "what was not drawn" "^1 case, 1 accepted, 2 undrawn$" check slow.whit --on reference --accept-from cut
check "but what was" test "$(grep -c " ids " slow.reference.golden)" -eq 1
sed -i 's/4000x3000 --aa 64/16x12/' slow.whit
expect 4 "drawn elsewhere" check slow.whit --on reference --only large --only other --json cut/s.json
sed -i 's/4000x3000 --aa 64/16x12/' cut/r.json
shows "one run has what another has not" "^3 cases, 1 ok, 2 accepted$" check slow.whit --on reference --accept-from cut
# Suites of many cases are drawn from both ends; output is in the order of the suite.
if part 1 2; then
{
    echo 'leaf-{1,2,3,4,5,6,7,8,9,10,11,12,13,14} cube.json --size 16x12 --leaf {}'
    printf 'one tri.obj --size 16x12\nbroken broken.json\ntwo tri.obj --size 16x12 --depth 0\n'
    printf 'lost cube.json --camera nobody\nlast cube.json --size 16x12 --leaf 15\n'
} >many.whit
expect 2 "many cases" check many.whit --json many.json
check "in the order of the suite" sh -c '"$1" check many.whit --list >names && cut -d: -f1 <stdout | head -n -1 | cmp - names' - "$WHIT"
check "all are counted" grep -qx "19 cases, 17 new, 2 broken" stdout
check "errors and a warning, once and in this order" sh -c 'sed -n "s/^whit: \(warning\|error: many.whit:[0-9]*: [a-z]*\):.*/\1/p" stderr |
    tr "\n" " " | grep -qx "warning error: many.whit:3: broken error: many.whit:5: lost "'
check "cases that differ in their trees alone are the same picture" jq -e '[.cases[] | select(.name | startswith("l")) |
    select(.verdict == "new") | .is.colors] | length == 15 and (unique | length) == 1' many.json >jq.out
expect 5 "a time limit of many cases" check many.whit --time-limit 0.001
fi

expect 5 "a time limit" check looks.whit --time-limit 0.001
export VK_DRIVER_FILES=/nonexistent VK_ICD_FILENAMES=/nonexistent
refuse 3 "no device" "no Vulkan driver" check slow.whit --json cut/r.json --junit cut/r.xml --report cut/r.html
undrawn "no device" 3 '["undrawn", "undrawn", "undrawn"]' "there is no device"
finish
