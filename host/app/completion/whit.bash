# bash completion for whit, which knows its own words.
_whit() {
    local current=${COMP_WORDS[COMP_CWORD]} previous=${COMP_WORDS[COMP_CWORD - 1]} words=
    local command=${COMP_WORDS[1]}
    if [ "$COMP_CWORD" -eq 1 ]; then
        words="$("$1" --complete 2>/dev/null | cut -f 1) --help --version"
    else
        [ "${previous#--}" = "$previous" ] ||
            words=$("$1" --complete "$command" "$previous" 2>/dev/null | cut -f 1)
        [ -n "$words" ] || [ "${current#-}" = "$current" ] ||
            words=$("$1" --complete "$command" 2>/dev/null | cut -f 1)
    fi
    COMPREPLY=()
    [ -z "$words" ] || mapfile -t COMPREPLY < <(compgen -W "$words" -- "$current")
    if [ -z "${COMPREPLY[0]-}" ]; then
        compopt -o filenames 2>/dev/null # words would get a slash where a folder has their name
        mapfile -t COMPREPLY < <(compgen -f -- "$current")
    fi
}
complete -F _whit whit
