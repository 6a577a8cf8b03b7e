#!/bin/sh
# words.sh ROOT: the words of an enumeration stand in host/settings/values.c alone. Names each file above
# host/api/ in which three words of one list (two, where there are no more) follow each other as strings.
# Names comments, too, that begin with words by which one cannot tell what they speak about.
cd "$1" || exit 1
bad=0
lists=$(tr '\n' ' ' <host/settings/values.c | grep -o 'values_[a-z_]*\[\] = {[^;]*;' | sed 's/ = .*//; s/\[\]//')
for list in $lists; do
    words=$(tr '\n' ' ' <host/settings/values.c | grep -o "$list\[\] = {[^;]*;" |
        grep -o '{"[^"]*"' | tr -d '{"' | paste -sd '|')
    case $list in
    # Words that many lists share, and numbers.
    values_packets | values_classes | values_instances | values_effects | *samples) continue ;;
    esac
    one="\"($words)\"" next="[^\";]{0,60}\"($words)\""
    case $words in *\|*\|*) next=$next$next ;; esac
    # shellcheck disable=SC2046
    if grep -lzE "$one$next" \
        $(find host/settings host/cost host/view host/app tools -name '*.[ch]' |
            grep -v '^host/settings/values.c$'); then
        echo "$list: its words stand in the files above too"
        bad=1
    fi
done
if grep -rnE '(^|[ ;{},])(/\*+|//+|#+) *(Of|That|Who) ' host shaders tools tests CMakeLists.txt \
    --include=*.c --include=*.h --include=*.cpp --include=*.glsl --include=*.comp --include=*.sh \
    --include=*.awk --include=*.cmake --include=*.py --include=CMakeLists.txt; then
    echo "comments begin with Of, That or Who: say what stands there, in a sentence"
    bad=1
fi
[ -n "$lists" ] && exit "$bad"
