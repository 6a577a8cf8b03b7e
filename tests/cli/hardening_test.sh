#!/bin/sh
# Program and library are built with the options for hardening: hardening_test.sh WHIT SCENES LIBWHIT [sanitized]
. "$(dirname "$0")/common.sh"
needs readelf

# holds WHAT PATTERN OPTION...: a line that readelf prints about $file matches PATTERN.
holds() {
    what=$1 pattern=$2
    shift 2
    readelf -W "$@" "$file" >"$OUT/lines"
    check "$what: readelf $* has a line with $pattern" grep -Eq "$pattern" "$OUT/lines"
}

file=$WHIT
holds "position-independent" 'Type: +DYN' --file-header
holds "addresses of functions are read-only" 'GNU_RELRO' --program-headers
holds "and all known at the start" 'BIND_NOW|Flags:.*NOW' --dynamic
holds "stack without code" 'GNU_STACK .* RW +0x' --program-headers
file=$3 # of which every object is whit's own
holds "stack overruns end it" 'UND __stack_chk_fail' --syms
[ "${4:-}" = sanitized ] || holds "checked copies" 'UND __(memcpy|snprintf)_chk' --syms
case $(uname -m) in
x86_64) holds "calls land where calls may" 'IBT, SHSTK' --notes ;;
esac
finish
