# See epsilons.sh. The first file is the list: of a line the first word is a file, or a folder with a
# slash at its end; the second a number as it is written, without its suffix, or a quotient of two
# without spaces; the third how often it stands there; the rest says why. The numbers are C's and GLSL's: 1e-3f, .5, 0x1p-20, 1.0 / 4096.0,
# and names that end in _EPSILON.

BEGIN {
    number = "(0[xX][0-9a-fA-F]*[.]?[0-9a-fA-F]*[pP][-+]?[0-9]+|[0-9]+[.][0-9]*([eE][-+]?[0-9]+)?|" \
             "[.][0-9]+([eE][-+]?[0-9]+)?|[0-9]+[eE][-+]?[0-9]+)"
    token = number "[fFlL]*|[A-Za-z_][A-Za-z_0-9]*|[0-9]+"
    digits = "0123456789abcdef"
}

# ---- The list ----

FNR == 1 { files++; comment = 0 }

files == 1 && /^[^#]/ {
    reason = $0
    sub(/^[^ ]+ +[^ ]+ +[0-9]+ */, "", reason)
    if (reason == "" || reason == $0)
        complain("no reason: " $0)
    left[$1 " " $2] = $3
}

files == 1 { next }

function complain(text) {
    print FILENAME ":" FNR ": " text
    bad++
}

# ---- Numbers ----

function hex_value(text,    parts, mantissa, value, scale, i, c) {
    split(tolower(text), parts, "p")
    mantissa = substr(parts[1], 3)
    value = 0
    scale = 0
    for (i = 1; i <= length(mantissa); i++) {
        c = substr(mantissa, i, 1)
        if (c == ".") {
            scale = length(mantissa) - i
            continue
        }
        value = 16 * value + index(digits, c) - 1
    }
    return value * 2 ^ (parts[2] - 4 * scale)
}

function value_of(text) {
    return text ~ /^0[xX]/ ? hex_value(text) : text + 0
}

function bare(text) {
    sub(/[fFlL]+$/, "", text)
    return text
}

# ---- Sources ----

# The line without comments; strings are empty.
function strip(line,    out, i, c, two) {
    out = ""
    for (i = 1; i <= length(line); i++) {
        c = substr(line, i, 1)
        two = substr(line, i, 2)
        if (comment) {
            if (two == "*/") {
                comment = 0
                i++
            }
        } else if (two == "/*") {
            comment = 1
            i++
        } else if (two == "//") {
            break
        } else if (c == "\"" || c == "'") {
            for (i++; i <= length(line) && substr(line, i, 1) != c; i++)
                if (substr(line, i, 1) == "\\")
                    i++
            out = out c c
        } else {
            out = out c
        }
    }
    return out
}

function check(text,    folder, key) {
    checked++
    folder = FILENAME
    for (;;) {
        key = folder " " text
        if (key in left && left[key] > 0) {
            left[key]--
            return
        }
        if (!sub(/[^\/]+\/?$/, "", folder) || folder == "")
            break
    }
    complain(text ": tests/source/epsilons.txt does not say why this is no epsilon in world units")
}

# `before` of a quotient is its dividend, or empty.
{
    rest = strip($0)
    before = ""
    while (match(rest, token)) {
        text = bare(substr(rest, RSTART, RLENGTH))
        between = substr(rest, 1, RSTART - 1)
        rest = substr(rest, RSTART + RLENGTH)
        if (text ~ /^[A-Za-z_]/) {
            if (text ~ /_EPSILON$/)
                check(text)
            before = ""
            continue
        }
        value = value_of(text)
        if (before != "" && between ~ /^ *\/ *$/ && value != 0) {
            quotient = value_of(before) / value
            if (quotient > 0 && quotient < 0.01)
                check(before "/" text)
            before = ""
        } else {
            if (value > 0 && value < 0.01)
                check(text)
            before = text
        }
    }
}

END {
    for (key in left)
        if (left[key] > 0) {
            print "tests/source/epsilons.txt: " left[key] " too many of " key
            bad++
        }
    if (files < 100 || checked < 50) {
        print "only " files " files and " checked " small numbers: the sources were not read"
        bad++
    }
    if (bad)
        print "FAILED: small numbers that nothing accounts for"
    print checked " small numbers in " files - 1 " files, " bad + 0 " of them not accounted for"
    exit bad > 0
}
