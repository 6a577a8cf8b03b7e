#!/bin/sh
# How program and library were built: hardening_test.sh WHIT LIBWHIT [sanitized]
command -v readelf > /dev/null || { echo "SKIPPED: no readelf (Debian: binutils)"; exit 77; }
file=$1
failed=0

# holds WHAT PATTERN OPTION ...: readelf's lines about $file have PATTERN.
holds() {
    what=$1 pattern=$2
    shift 2
    readelf -W "$@" "$file" | grep -E "$pattern" >/dev/null && return
    echo "$what: readelf $* has no line with $pattern"
    failed=1
}

holds "position-independent" 'Type: +DYN' --file-header
holds "addresses of functions are read-only" 'GNU_RELRO' --program-headers
holds "and all known at the start" 'BIND_NOW|Flags:.*NOW' --dynamic
holds "stack without code" 'GNU_STACK .* RW +0x' --program-headers
file=$2 # of which every object is whit's own
holds "stack overruns end it" 'UND __stack_chk_fail' --syms
[ "$3" = sanitized ] || holds "checked copies" 'UND __(memcpy|snprintf)_chk' --syms
case $(uname -m) in
x86_64) holds "calls land where calls may" 'IBT, SHSTK' --notes ;;
esac
exit $failed
