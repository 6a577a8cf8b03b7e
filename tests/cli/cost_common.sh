# Tests of `whit cost` source this file after common.sh.
WRONG=${3:-}
XDG_CACHE_HOME=$OUT/cache
export XDG_CACHE_HOME
mkdir "$OUT/cache" "$OUT/files"

# value FILE KNOB SETTING COLUMN: prints a figure of the CSV. A comma within a cell has a space behind it, one between
# cells has none.
value() {
    sed 's/, /; /g; s/"//g' "$1" | awk -F, -v knob="$2" -v setting="$3" -v column="$4" '
        NR == 1 { for (i = 1; i <= NF; ++i) at[$i] = i }
        $at["knob"] == knob && $at["setting"] == setting { print $at[column] }'
}

# wrong FAULT COMMAND...: runs the command by a whit with that fault.
wrong() {
    export WHIT_TEST_WRONG="$1"
    shift
    "$@"
    unset WHIT_TEST_WRONG
}
