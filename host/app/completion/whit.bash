# bash completion for whit: commands and options as `--help` lists them.
_whit() {
    local current=${COMP_WORDS[COMP_CWORD]} previous=${COMP_WORDS[COMP_CWORD - 1]} words=
    if [ "$COMP_CWORD" -eq 1 ]; then
        words="$("$1" --help 2>/dev/null | sed -n 's/^  \([a-z][a-z]*\)  .*/\1/p') --help --version"
    elif [ "${current#-}" != "$current" ]; then
        words=$("$1" "${COMP_WORDS[1]}" --help 2>/dev/null | grep -o -- '--[a-z][a-z-]*')
    else
        case $previous in
        --aa) words="1 4 16 64" ;;
        --build) words="binned median sweep spatial binned+opt sweep+opt spatial+opt" ;;
        --effects) words="auto all" ;;
        --instances) words="auto on off" ;;
        --instance-build) words="sah median" ;;
        --instance-update) words="rebuild refit" ;;
        --load-path) words="auto storage texel" ;;
        --numerics) words="fast watertight exact" ;;
        --metric)
            words="rmse relmse largest mean over differing flip"
            [ "${COMP_WORDS[1]}" = cost ] && words="rmse flip"
            ;;
        --samples) words="4 16 64" ;;
        --knobs)
            words="aa depth bailout light-samples fresnel tinted-shadows shadows textures normal-maps"
            words="$words terminator numerics instances traversal build load-path"
            ;;
        --on) words="device cpu brute" ;;
        --stats) words="text json" ;;
        --view)
            words="color depth visits boxes tris stack"
            [ "${COMP_WORDS[1]}" = hard ] && words=leaks
            ;;
        --view-rays) words="primary shadow reflected refracted all" ;;
        --traversal) words="distance sign basic" ;;
        esac
    fi
    if [ -n "$words" ]; then
        mapfile -t COMPREPLY < <(compgen -W "$words" -- "$current")
    else
        mapfile -t COMPREPLY < <(compgen -f -- "$current")
    fi
}
complete -o filenames -F _whit whit
