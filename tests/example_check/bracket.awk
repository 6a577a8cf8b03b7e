# A bracket of three boxes, in millimetres: awk -f bracket.awk </dev/null >bracket.stl
function box(x0, y0, z0, x1, y1, z1,    i, corner) {
    for (i = 0; i < 36; ++i) {
        corner = substr("023031457476015054267273046062137175", i + 1, 1)
        if (i % 3 == 0)
            print "facet normal 0 0 0\nouter loop"
        print "vertex", (corner % 2 ? x1 : x0), (int(corner / 2) % 2 ? y1 : y0), (corner < 4 ? z0 : z1)
        if (i % 3 == 2)
            print "endloop\nendfacet"
    }
}
BEGIN {
    print "solid bracket"
    box(0, 0, 0, 60, 40, 5)
    box(0, 0, 5, 5, 40, 50)
    box(5, 18, 5, 25, 22, 30)
    print "endsolid bracket"
}
