#!/bin/sh
# Texts made from the tables of options: completion, manual pages, and the tables of docs/cli.md.
. "$(dirname "$0")/common.sh"
needs bash
DOCS=$SCENES/../docs/cli.md
mkdir "$OUT/man" && expect 0 "manual pages" --manual "$OUT/man"
check "a page for whit" test -s "$OUT/man/whit.1"
tab=$(printf '\t')

for command in $("$WHIT" --complete | cut -f 1); do
    "$WHIT" "$command" --help >"$OUT/help"
    check "$command has a page" test -s "$OUT/man/whit-$command.1"
    sed 's/\\-/-/g' "$OUT/man/whit-$command.1" >"$OUT/page"
    "$WHIT" --complete "$command" >"$OUT/options"
    check "$command: as many options as in its help" test \
        "$(grep -c '^--' "$OUT/options")" -ge "$(grep -cE '^(  -., |      )--' "$OUT/help")"
    missing=
    for option in $(cut -f 1 "$OUT/options"); do
        grep -qE "^\.B (-., )?$option( |\$)" "$OUT/page" || missing="$missing page:$option"
    done
    check "$command: its page has all options$missing" test -z "$missing"
done
if "$WHIT" view --help >/dev/null 2>&1; then
    "$WHIT" --options >"$OUT/table"
    sed -n '/^| option | commands | meaning |$/,/^$/p' "$DOCS" | sed '$d' >"$OUT/docs"
    check "the table of docs/cli.md is what whit --options prints" cmp "$OUT/table" "$OUT/docs"
else
    echo "SKIPPED part: the table of docs/cli.md has the viewer's options"
fi
if command -v groff >/dev/null; then
    for page in "$OUT"/man/*.1; do
        groff -man -Tutf8 -ww "$page" >/dev/null 2>>"$OUT/troff"
    done
    check "troff has nothing to say" test ! -s "$OUT/troff"
else
    echo "SKIPPED part: no groff"
fi

# complete_words WORD...: prints the words that bash offers for the last one.
complete_words() {
    bash -c 'whit=$1; shift; set -- "$@"
        . "$0" && COMP_WORDS=("$whit" "$@") && COMP_CWORD=$# && _whit "$whit" && echo "${COMPREPLY[@]}"' \
        "$SCENES/../host/app/completion/whit.bash" "$WHIT" "$@"
}
check "commands" test "$(complete_words ren)" = render
check "options" test "$(complete_words render --nu)" = --numerics
check "words of an enumeration" test "$(complete_words render --numerics "")" = "fast watertight exact"
check "knobs, arithmetic too" test "$(complete_words cost --knobs ar)" = arithmetic
check "gone options are not offered" test -z "$("$WHIT" --complete render | grep '^--tree')"
(cd "$SCENES" && complete_words render cub) >"$OUT/files"
check "files" test "$(cat "$OUT/files")" = cube.json
(cd "$SCENES" && complete_words cub) >"$OUT/files"
check "files in place of a command" test "$(cat "$OUT/files")" = cube.json
(cd "$SCENES" && complete_words cube.json --nu) >"$OUT/files"
check "options of such a file" grep -qx -e --numerics -e "" "$OUT/files" # "": there is no window
mkdir "$OUT/named" && touch "$OUT/named/bvh"
check "a command has its options beside a file of its name" \
    test "$(cd "$OUT/named" && complete_words bvh --ru)" = --runs
check "words that begin like options" test "$(complete_words render --up -z)" = -z

# offered SHELL WORD...: prints the words that zsh or fish offers for the last word, without their help.
offered() {
    shell=$1
    shift
    (cd "$SCENES" && PATH=$(dirname "$WHIT"):$PATH && case $shell in
        fish) HOME=$OUT fish --no-config -c 'source $argv[1]; complete -C "$argv[2]"' \
            ../host/app/completion/whit.fish "$*" | cut -f 1 ;;
        zsh) zsh -f -c '_describe() { local -a all=("${(@P)2}"); print -rl -- ${all%%:*} } && _files() { print -r files }
            words=("$@") CURRENT=$# && _whit() { . ../host/app/completion/_whit } && _whit' - "$@" ;;
    esac | tr '\n' ' ')
}
for shell in fish zsh; do
    if ! command -v $shell >/dev/null; then
        echo "SKIPPED part: no $shell"
        continue
    fi
    check "$shell: commands" sh -c 'expr "$1" : ".*render " >/dev/null' - " $(offered $shell whit ren)"
    check "$shell: options" sh -c 'expr "$1" : ".*--numerics " >/dev/null' - " $(offered $shell whit render --nu)"
    words=$(offered $shell whit render --numerics "" | tr ' ' '\n' | sort | tr '\n' ' ')
    check "$shell: words of an enumeration ($words)" test "${words# }" = "exact fast watertight "
    check "$shell: words that begin like options" sh -c 'expr "$1" : ".*-z " >/dev/null' - " $(offered $shell whit render --up -z)"
    files=$(offered $shell whit render cub)
    check "$shell: files ($files)" test "$files" = "cube.json " -o "$files" = "files "
done
check "the form without a command has its line" grep -q "^FILE .options.$" "$OUT/man/whit.1"
check "an about behind each word" test -z "$("$WHIT" --complete | grep -v "$tab.")"
finish
