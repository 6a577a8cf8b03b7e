#!/bin/sh
# declarations.sh ROOT: what another source calls is declared once, in the header of its own source's name. One
# function alone of a source may stand in another header of the folder, that of the thing which it is a part
# of. Names what is declared elsewhere, or twice.
cd "$1" || exit 1
# Faces of modules, and tables whose entries are called by their kind; host/view/ is yet to be divided.
faces='^host/(whit/.*|view/.*|bvh/build|cost/cost|device/swapchain|image/formats|render/render|settings/settings)[.]h$'
# shellcheck disable=SC2046
awk -v faces="$faces" '
FNR == 1 { name = ""; header = FILENAME ~ /[.]h$/ }
/^[A-Za-z].*[A-Za-z0-9_][(]/ && !/^(static|typedef|extern) / {
    name = $0
    sub(/[(].*/, "", name)
    sub(/.*[ *]/, "", name)
}
/^[{]/ && !header && name { source[name] = FILENAME }
/;$/ && header && name {
    if (name in declared) {
        print name ": declared in " declared[name] " and in " FILENAME
        bad = 1
    }
    declared[name] = FILENAME
}
/[;{]$/ { name = "" }
END {
    for (name in declared) {
        if (!(name in source))
            continue
        ++known
        of = source[name]
        own = of
        sub(/[.][a-z]+$/, ".h", own)
        if (own == declared[name] || declared[name] ~ faces)
            continue
        folder = declared[name]
        sub(/[^\/]*$/, "", folder)
        elsewhere[of] += index(of, folder) == 1 ? 1 : 2
        list[of] = list[of] "\n    " name " in " declared[name]
    }
    for (of in elsewhere) {
        if (elsewhere[of] > 1) {
            print of ": has no header of its name for" list[of]
            bad = 1
        }
    }
    if (known < 500)
        print "only " known + 0 " functions were found"
    exit bad || known < 500
}' $(find host tools/bench -name '*.[ch]' -o -name '*.cpp')
