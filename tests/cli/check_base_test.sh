#!/bin/sh
# whit check --base names the part of the input that changed a picture, by drawing the input of a revision of git.
. "$(dirname "$0")/common.sh"
needs git
cd "$OUT" || exit 1
TMPDIR=$OUT/tmp
export TMPDIR GIT_CONFIG_GLOBAL=/dev/null GIT_CONFIG_NOSYSTEM=1
mkdir -p tmp work/suite
cat >work/suite/a.json <<'END'
{ "camera": { "eye": [0, 1, 4], "target": [0, 0.5, 0], "fov": 40 },
  "lights": [ { "name": "lamp", "kind": "point", "position": [2, 4, 3], "color": [1, 1, 1], "intensity": 20 } ],
  "materials": {
    "glass": { "transmission": 1, "ior": 1.5 },
    "floor": { "texture": { "checker": { "colors": ["#ffffff", "#202020"], "size": 8 } } },
    "unused": { "diffuse": [0.5, 0.5, 0.5] } },
  "objects": [
    { "name": "floor", "shape": "plane", "size": 6, "material": "floor" },
    { "name": "ball", "shape": "ball", "radius": 0.6, "translation": [0, 0.6, 0], "material": "glass" },
    { "name": "tent", "model": "tent.obj", "translation": [-1, 0, 0] } ] }
END
cat >work/suite/tent.obj <<'END'
o tent
v 0 0 0
v 1 0 0
v 0 1 0.5
v 1 1 0.5
f 1 2 3
f 2 4 3
END
printf '//@ slider gain 0 4 1\n#include "tint.glsl"\nvec3 post(ivec2 at, vec3 color) { return tint(color) * gain; }\n' >work/suite/post.glsl
echo 'vec3 tint(vec3 color) { return color; }' >work/suite/tint.glsl
(cd work/suite && for name in vertex gone two plain; do sed "s/tent.obj/$name.obj/" a.json >$name.json; cp tent.obj $name.obj; done)
cat >work/suite/looks.whit <<'END'
material a.json --size 48x36
option plain.json --size 48x36 --depth 5
functions plain.json --size 48x36 --shader post.glsl
slider plain.json --size 48x36 --shader post.glsl --set gain=2
{vertex,gone,two} {}.json --size 48x36
new a.json --size 32x24
END
cd work || exit 1
refuse 2 "no repository" "base HEAD: fatal: not a git repository" check suite/looks.whit --base HEAD
git init -q . && git config user.name a && git config user.email a@b
expect 0 "accepted" check suite/looks.whit --accept all
sed '/^new/d' suite/looks.whit >without
mv suite/looks.whit with && mv without suite/looks.whit && git add -A && git commit -qm first && mv with suite/looks.whit
cp suite/looks.whit suite/later.whit
refuse 2 "a suite that was not there" "base HEAD: it has no suite/later.whit" check suite/later.whit --base HEAD
rm suite/later.whit
refuse 2 "no such revision" "base nope: fatal: invalid reference" check suite/looks.whit --base nope
refuse 2 "an option for a revision" "base --help: no revision" check suite/looks.whit --base=--help

edit() { sed -i "$2" "suite/$1"; }
edit a.json 's/"ior": 1.5/"ior": 1.6/; s/"diffuse": \[0.5/"diffuse": [0.9/; /"tent"/s/-1, 0, 0/9, 0, 9/'
edit looks.whit 's/--depth 5/--depth 1/'
edit tint.glsl 's/return color/return color * 2.0/'
edit looks.whit 's/gain=2/gain=3/'
edit vertex.obj 's/v 1 1 0.5/v 1 1.25 0.5/'
edit gone.json '/"name": "floor", "shape"/d'
edit two.obj 's/v 1 1 0.5/v 1 1.25 0.5/'
edit two.json 's/"intensity": 20/"intensity": 21/; s/#202020/#203020/'
expect 1 "without a base" check suite/looks.whit --only slider
check "a file that is included and a slider are told" grep -q '; input changed: functions of suite/post.glsl, `plain.json .*--set gain=3`, was `plain.json .*--set gain=2`$' \
    "$OUT/stdout"
expect 1 "all of it" check suite/looks.whit --base HEAD --report page.html
cp "$OUT/stdout" "$OUT/said"
check "the page has what was" test "$(grep -o "\"before\":\"data:image/png" page.html | wc -l)" -eq 7
check "its causes, and commands" test "$(grep -o '"cause":"[0-9]* pixels other' page.html | wc -l)" -eq 7 -a \
    "$(grep -o '"command":"whit render ' page.html | wc -l)" -eq 8
# says CASE PATTERN: the verdict of the case is `differs`, with PATTERN in it.
says() { check "$1: \`$2\`" grep -q "^$1: differs: .*$2" "$OUT/said"; }
says material 'cause: material "glass", ior from 1.5 to 1.6; and objects, node "tent" moved by 13; input changed, picture same: material "unused"; pixel [0-9]*,[0-9]*: '
says option 'cause: --depth from 5 to 1; pixel'
says functions 'cause: functions of suite/post.glsl; pixel'
says slider 'cause: --set from gain=2 to gain=3; and functions of suite/post.glsl; pixel'
says vertex ' pixels other, [0-9]* hit something else; cause: mesh "vertex.obj", vertex 3 moved by 0.25; pixel [0-9]*,[0-9]*: was nothing, is vertex.obj 1 at [0-9.]*$'
says gone 'cause: objects, mesh "floor" is gone, .*, is nothing$'
says two 'cause: mesh "two.obj", vertex 3 .*; and material "floor", texture of diffuse from "checker #ffffff #202020" to "checker #ffffff #203020"; and light "lamp", colour from 20 20 20 to 21 21 21; pixel'
says new 'HEAD has no such case'
check "nothing is left" test -z "$(ls "$TMPDIR")" -a "$(git worktree list | wc -l)" -eq 1

# In a hook git names, by variables, the index of the commit that it makes; the tree of the revision has another one.
echo more >more.txt
printf '#!/bin/sh\n"%s" check suite/looks.whit --only slider --base HEAD >"%s/hook"\nexit 0\n' "$WHIT" "$OUT" >.git/hooks/pre-commit
chmod +x .git/hooks/pre-commit
check "a hook: the commit is made" sh -c 'git add more.txt && git commit -qam hooked'
check "a hook: the cause is found" grep -q '^slider: differs: .*cause: --set from gain=2 to gain=3' "$OUT/hook"
check "a hook: the commit has what was added and changed" test "$(git diff --name-only HEAD~1 | grep -c 'more.txt\|a.json')" -eq 2
git reset -q HEAD~1
# In a second worktree these variables name other places.
git worktree add -q --detach linked HEAD && cp -R suite more.txt linked && rm "$OUT/hook"
check "a hook of a second worktree: the commit is made" sh -c 'cd linked && git add -A && git commit -qm linked'
check "a hook of a second worktree: the cause is found" grep -q '^slider: differs: .*cause: --set from gain=2 to gain=3' "$OUT/hook"
check "a hook of a second worktree: the commit has what was added and changed" \
    test "$(git -C linked diff --name-only HEAD~1 | grep -c 'more.txt\|a.json')" -eq 2
git worktree remove --force linked && rm .git/hooks/pre-commit

# The tree of the revision is removed even if whit is interrupted, or ended by a signal that no program can catch.
is_there() { test -e "$(echo "$TMPDIR"/whit-base-*)/tree/suite/looks.whit"; }
is_gone() { test -z "$(ls "$TMPDIR")" -a "$(git worktree list | wc -l)" -eq 1; }
for signal in INT KILL; do
    "$WHIT" check suite/looks.whit --base HEAD >/dev/null 2>&1 &
    check "$signal: the tree is there" wait_for $! is_there
    kill -$signal $!
    wait $! 2>/dev/null
    check "$signal: nothing is left" wait_for $$ is_gone
done
# So it is if whit is ended while git still writes the tree, here two folders of 2000 files.
mkdir suite/more suite/z && (cd suite/more && seq 2000 | split -l 1 -a 3 && cp ./* ../z) && git add suite && git commit -qm files
"$WHIT" check suite/looks.whit --base HEAD >/dev/null 2>&1 &
check "git is busy: the tree is there" wait_for $! is_there
test ! -e "$(echo "$TMPDIR"/whit-base-*)/tree/suite/z/ccx" || echo "note    git had written all files by then"
kill -KILL $!
wait $! 2>/dev/null
sleep 1 # it may be gone for a moment only
check "git is busy: nothing is left" wait_for $$ is_gone

# The commit above has all the changes, but the golden of before.
expect 1 "a change that was committed, but not accepted" check suite/looks.whit --only option --base HEAD
check "is older than that" grep -qx "option: differs: HEAD gives this picture too, but its golden does not have it: an older .*" "$OUT/stdout"
cp suite/looks.golden before
expect 0 "accepted" check suite/looks.whit --accept option --reason "fewer bounces"
git commit -qam accepted && cp before suite/looks.golden
expect 1 "a golden of before" check suite/looks.whit --only option --base HEAD
check "is older than the revision" grep -qx "option: differs: HEAD gives this picture too, and its golden has it: .*" "$OUT/stdout"

# A file that the revision lacks matters to the cause of its own case alone.
cp suite/plain.json suite/made.json && echo made.json >.gitignore
printf '{plain,made} {}.json --size 16x12\n' >suite/made.whit && echo 'a a.json --sice 3' >suite/wrong.whit
expect 0 "accepted" check suite/made.whit --accept all
echo 'up ../suite/plain.json' >>suite/made.whit # as suites of before may have
git add -A && git commit -qm made && sed -i '/^up/d' suite/made.whit
edit plain.json 's/"radius": 0.6/"radius": 0.7/' && edit made.json 's/"radius": 0.6/"radius": 0.7/' && edit wrong.whit 's/sice/aa/'
gives 1 "a file that the revision lacks" "^made: differs: HEAD has no suite/made.json$" check suite/made.whit --base HEAD
check "the other case has a cause" grep -q '^plain: differs: .*cause: mesh "ball"' "$OUT/stdout"
refuse 2 "a wrong line of the revision" "base HEAD: suite/wrong.whit:1: there is no option" check suite/wrong.whit --base HEAD
finish
