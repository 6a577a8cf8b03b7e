#!/bin/sh
# words.sh ROOT: the words of an enumeration stand in host/settings/values.c alone. Names each file above
# host/api/ in which three words of one list (two, where there are no more) follow each other as strings.
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
[ -n "$lists" ] && exit "$bad"
