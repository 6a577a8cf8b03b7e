#!/bin/sh
# Goldens of whit check under git: if two people accept different cases, git merges the goldens without a conflict.
. "$(dirname "$0")/common.sh"
needs git
cd "$OUT" || exit 1
export GIT_CONFIG_GLOBAL=/dev/null GIT_CONFIG_SYSTEM=/dev/null
git init -q -b main . && git config user.name t && git config user.email t@t

# scene NAME ANGLE: writes a scene of that name, with another picture for each angle.
scene() {
    echo "{ \"objects\": [ { \"name\": \"$1\", \"shape\": \"box\", \"rotation\": [0, $2, 0] } ] }" >"$1.json"
}
# suite NAME...: writes a suite of these cases. Some lines never change, as in a suite that people write.
suite() {
    for name in "$@"; do
        printf '# %s\n%s %s.json --size 16x12\n\n' "$name" "$name" "$name"
    done >looks.whit
}
# accept NAME [REASON]: accepts the present picture of the case into the golden.
accept() {
    "$WHIT" check looks.whit --accept "$1" ${2:+--reason "$2"} >accepted 2>&1 || { cat accepted; FAILED=1; }
}
commit() {
    git add ./*.json looks.* && git commit -qm "$1"
}
# merges WHAT OURS THEIRS: git merges the changes of the two shell functions, which change something and accept it.
merges() {
    git checkout -q -B ours base && "$2" && commit ours
    git checkout -q -B theirs base && "$3" && commit theirs
    git checkout -q -B merged ours
    check "$1: no conflict" git merge -q --no-edit theirs
    expect 0 "$1: all as it was accepted" check looks.whit
    check "$1: nothing but that" test ! -s stderr
    cp looks.golden merged
    expect 0 "$1: accepted as it is" check looks.whit --accept all
    check "$1: the merged golden is what whit writes" cmp merged looks.golden
    git checkout -q -f merged
}

suite a b c
for name in a b c; do scene $name 20; done
accept all
commit base
git branch base

a_is_other() { scene a 30; accept a "turned"; }
b_is_other() { scene b 40; accept b "turned too"; }
c_is_other() { scene c 40; accept c "turned"; }
new_behind_a() { suite a aa b c; scene aa 10; accept aa; }
new_behind_b() { suite a b bb c; scene bb 15; accept bb "it is new"; }
new_last() { suite a b c d; scene d 15; accept d "it is last"; }
b_goes() { suite a c; git rm -q b.json; "$WHIT" check looks.whit --prune >pruned 2>&1 || FAILED=1; }

both_new() { suite a ab ac b c; scene ab 10; scene ac 15; }
ab_is_new() { both_new; suite a ab b c; accept ab "it is new"; }
ac_is_new() { both_new; suite a ac b c; accept ac; }
a_is_another() { scene a 50; accept a "turned more"; }
ab_is_another() { both_new; scene ab 30; suite a ab b c; accept ab; }

merges "neighbours" a_is_other b_is_other
merges "two new ones at different places" new_behind_a new_behind_b
merges "a new one behind one that is other" a_is_other new_behind_a
merges "the last one, and a new last one" c_is_other new_last
merges "one that goes beside one that is other" b_goes c_is_other

# Two new cases between the same two neighbours merge by git's driver `union`. The suite is merged by people.
git checkout -q -B ours base
printf '*.golden merge=union\n' >.gitattributes
git add .gitattributes && git commit -qm attributes && git branch -f base
# union WHAT OURS THEIRS: as merges, but with a suite that has the cases of both.
union() {
    git checkout -q -B ours base && "$2" && commit ours
    git checkout -q -B theirs base && "$3" && commit theirs
    git checkout -q -B merged ours
    git merge -q --no-commit theirs >merge.out 2>&1
    check "$1: no conflict in the golden" test "$(git ls-files -u looks.golden | wc -l)" -eq 0
}
union "two new ones at one place" ab_is_new ac_is_new
suite a ab ac b c
shows "both are there" "^5 cases, 5 ok$" check looks.whit
cp looks.golden merged
expect 0 "accepted as they are" check looks.whit --accept all
check "both are in it, with the reason" test "$(sort -u merged)" = "$(sort -u looks.golden)"
git checkout -q -f merged
union "neighbours" a_is_other b_is_other
git checkout -q -f theirs -- a.json b.json && git checkout -q -f ours -- a.json
suite a b c
expect 0 "all as accepted" check looks.whit
git checkout -q -f merged
union "the same one by two" a_is_other a_is_another
refuse 2 "is told" "looks.golden:[0-9]*: a line above, from line 3 on, says something else of the case .a., which two" check looks.whit
git checkout -q -f merged
union "two new ones of one name" ab_is_new ab_is_another
suite a ab b c
refuse 2 "are told" "looks.golden:[0-9]*: .*of the case .ab., which two" check looks.whit
finish
