#!/bin/sh
# tables.sh ROOT: a table of the docs that an empty line cuts in two is two, and the second one has no
# head. Names each line that begins a table without one.
awk 'FNR == 1 { if (start) { print last ":" start ": a table without a head"; bad = 1 }
        before = ""; fenced = 0; start = 0; last = FILENAME }
    /^```/ { fenced = !fenced }
    start && !fenced && $0 !~ /^\|[-:| ]+$/ { print FILENAME ":" start ": a table without a head"; bad = 1 }
    { start = !fenced && /^\|/ && before !~ /^\|/ ? FNR : 0; before = $0 }
    END { if (start) { print last ":" start ": a table without a head"; bad = 1 }
        exit bad }' "$1"/README.md "$1"/docs/*.md "$1"/scenes/*.md
