#!/bin/sh
# declarations.sh ROOT: what another source calls is declared once, in the header of its own source's name, or
# in NAME_private.h where NAME.h is what others outside of the folder see. One function alone of a source may
# stand in another header of the folder, that of the thing which it is a part of. Names what is declared
# elsewhere, or twice.
cd "$1" || exit 1
# Faces of modules, and tables whose entries are called by their kind. view/engine.h: what the window asks of
# the engine, whatever source answers. view/ui.h: Dear ImGui for C, whose two sources are C++.
faces='^host/(whit/.*|bvh/build|cost/cost|device/swapchain|image/formats|render/render|settings/settings|view/(engine|ui))[.]h$'
# shellcheck disable=SC2046
awk -v faces="$faces" '
{ sub(/ *\/[*].*/, "") }
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
        inside = own
        sub(/[.]h$/, "_private.h", inside)
        if (own == declared[name] || inside == declared[name] || declared[name] ~ faces)
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
