# bash completion for whit, which knows its own words.
_whit() {
    local current=${COMP_WORDS[COMP_CWORD]} previous=${COMP_WORDS[COMP_CWORD - 1]} words=
    if [ "$COMP_CWORD" -eq 1 ]; then
        words="$("$1" --complete 2>/dev/null | cut -f 1) --help --version"
    elif [ "${current#-}" != "$current" ]; then
        words=$("$1" --complete "${COMP_WORDS[1]}" 2>/dev/null | cut -f 1)
    elif [ "${previous#--}" != "$previous" ]; then
        words=$("$1" --complete "${COMP_WORDS[1]}" "$previous" 2>/dev/null | cut -f 1)
    fi
    COMPREPLY=()
    [ -z "$words" ] || mapfile -t COMPREPLY < <(compgen -W "$words" -- "$current")
    [ -n "${COMPREPLY[0]-}" ] || mapfile -t COMPREPLY < <(compgen -f -- "$current")
}
complete -o filenames -F _whit whit
