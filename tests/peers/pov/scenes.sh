#!/bin/sh
# One scene for both ray tracers: writes NAME.json for whit and NAME.pov for POV-Ray into FOLDER.
#     sh scenes.sh flake|glass|hollow|wine|mesh colors|masks WIDTH HEIGHT BOUNCES FOLDER
# colors: lit as the scene says. masks: every object in one flat colour of its own, so that only the
# geometry and the camera count.
#
# Both programs get the same scene: POV-Ray is left-handed, so its camera's `right` is negative and all coordinates
# stay as they are; `angle` is the horizontal one; gamma is 1 throughout. `specular` with `roughness`
# 1 / n is Blinn's (n.h)^n, as whit has it. A light that fades with fade_distance f and fade_power 2 is
# 2 / (1 + (d/f)^2) of its colour, which for a small f is inverse square within (f/d)^2.
set -eu
name=$1 mode=$2 width=$3 height=$4 depth=$5 folder=$6

awk -v name="$name" -v mode="$mode" -v width="$width" -v height="$height" -v depth="$depth" \
    -v json="$folder/$name.json" -v pov="$folder/$name.pov" '
function rgb(r, g, b) { return sprintf("%.9g,%.9g,%.9g", r, g, b) }

# --- what both have ---

function begin(eye, target, fov, background,    half) {
    half = fov * atan2(0, -1) / 360
    wide = 2 * atan2(sin(half) / cos(half) * width / height, 1) * 180 / atan2(0, -1)
    printf "{\n\"ambient\": 0,\n\"environment\": [%s],\n", mode == "masks" ? "0,0,0" : background > json
    printf "\"camera\": {\"eye\": [%s], \"target\": [%s], \"fov\": %.9g},\n", eye, target, fov > json
    printf "#version 3.7;\nglobal_settings { assumed_gamma 1.0 ambient_light rgb 1 " > pov
    printf "max_trace_level %d adc_bailout 0.0005 }\n", depth + 1 > pov
    printf "background { rgb <%s> }\n", mode == "masks" ? "0,0,0" : background > pov
    printf "camera { perspective location <%s> up y right -x*%d/%d angle %.9g look_at <%s> }\n", eye,
        width, height, wide, target > pov
    lights = materials = objects = ""
}
# Inverse square, of intensity per channel; or without falloff.
function light(at, r, g, b, falloff,    f, scale) {
    f = 0.001
    scale = falloff ? 1 / (2 * f * f) : 1
    lights = lights sprintf("%s\n  {\"kind\": \"point\", \"position\": [%s], \"color\": [%s], \"falloff\": %s}",
        lights == "" ? "" : ",", at, rgb(r, g, b), falloff ? "true" : "false")
    printf "light_source { <%s> rgb <%s> %s }\n", at, rgb(r * scale, g * scale, b * scale),
        falloff ? "fade_distance " f " fade_power 2" : "" > pov
}
# A material: `diffuse`, then what else each of them takes.
function material(id, diffuse, jsonmore, povmore) {
    count++
    if (mode == "masks") {
        # Apart in one channel at least; background: 0, 0, 0.
        flat = rgb(0.2 + 0.6 * (count % 2), 0.3 * (int(count / 2) % 3), 0.8 * (int(count / 6) % 2))
        materials = materials sprintf("%s\n  \"%s\": {\"unlit\": true, \"color\": [%s]}",
            materials == "" ? "" : ",", id, flat)
        printf "#declare M_%s = texture { pigment { rgb <%s> } finish { ambient 1 diffuse 0 } }\n", id, flat > pov
        return
    }
    materials = materials sprintf("%s\n  \"%s\": {\"diffuse\": [%s], \"ambient\": 0%s}",
        materials == "" ? "" : ",", id, diffuse, jsonmore)
    printf "#declare M_%s = texture { pigment { rgb <%s> } finish { ambient 0 diffuse 1 %s } }\n", id, diffuse,
        povmore > pov
}
function object(text) { objects = objects (objects == "" ? "\n  " : ",\n  ") text }
# In masks neighbours differ: seven colours in turn.
function ball(x, y, z, r, id, povmore, whit_alone) {
    if (mode == "masks") {
        id = "ball" balls % 7
        if (balls++ < 7)
            material(id)
    }
    object(sprintf("{\"shape\": \"ball\", \"radius\": %.9g, \"translation\": [%s], \"material\": \"%s\"}",
        r, rgb(x, y, z), id))
    if (!whit_alone)
        printf "sphere { <%s>, %.9g texture { M_%s } %s }\n", rgb(x, y, z), r, id, povmore > pov
}
function finish() {
    printf "\"lights\": [%s\n],\n\"materials\": {%s\n},\n\"objects\": [%s\n]\n}\n", lights, materials, objects > json
}
# A floor of squares of one unit at height y, between two greys as 8-bit sRGB codes.
function floor_of_squares(size, y, first, second,    a, b) {
    a = linear(first); b = linear(second)
    if (mode == "masks")
        material("floor", "1,1,1")
    else
        materials = materials sprintf("%s\n  \"floor\": {\"diffuse\": 1, \"ambient\": 0, \"texture\": {\"checker\": {\"colors\": [\"#%02x%02x%02x\", \"#%02x%02x%02x\"], \"size\": %d}}}",
            materials == "" ? "" : ",", first, first, first, second, second, second, size)
    if (mode != "masks")
        printf "#declare M_floor = texture { pigment { checker rgb %.9g rgb %.9g translate y*0.5 } finish { ambient 0 diffuse 1 } }\n", b, a > pov
    object(sprintf("{\"shape\": \"plane\", \"size\": %d, \"translation\": [0, %g, 0], \"material\": \"floor\"}", size, y))
    printf "mesh { triangle { <-%g,%g,-%g>,<%g,%g,-%g>,<%g,%g,%g> } triangle { <-%g,%g,-%g>,<%g,%g,%g>,<-%g,%g,%g> } texture { M_floor } }\n",
        size/2, y, size/2, size/2, y, size/2, size/2, y, size/2, size/2, y, size/2, size/2, y, size/2, size/2, y, size/2 > pov
}
function linear(code,    s) {
    s = code / 255
    return s <= 0.04045 ? s / 12.92 : exp(2.4 * log((s + 0.055) / 1.055))
}

# --- flake: a ball with nine balls on it, and nine on each of those (Haines 1987) ---

function flake(x, y, z, r, ux, uy, uz, level,    i, a, e, px, py, pz, qx, qy, qz, l, dx, dy, dz, s) {
    ball(x, y, z, r, "mirror")
    if (level == 0)
        return
    # A frame around the way out.
    if (ux < 0.7 && ux > -0.7) { px = 0; py = uz; pz = -uy } else { px = -uz; py = 0; pz = ux }
    l = sqrt(px * px + py * py + pz * pz)
    px /= l; py /= l; pz /= l
    qx = uy * pz - uz * py; qy = uz * px - ux * pz; qz = ux * py - uy * px
    s = r / 3
    for (i = 0; i < 9; i++) {
        e = i < 6 ? 0.2 : 1.0 # radians above the equator
        a = (i < 6 ? i * 60 : 30 + (i - 6) * 120) * atan2(0, -1) / 180
        dx = cos(e) * (cos(a) * px + sin(a) * qx) + sin(e) * ux
        dy = cos(e) * (cos(a) * py + sin(a) * qy) + sin(e) * uy
        dz = cos(e) * (cos(a) * pz + sin(a) * qz) + sin(e) * uz
        flake(x + dx * (r + s), y + dy * (r + s), z + dz * (r + s), s, dx, dy, dz, level - 1)
    }
}
function flake_scene() {
    begin("2.1,1.7,3.2", "0,0.1,0", 45, "0.1,0.2,0.4")
    light("4,5,4", 30, 30, 28, 1)
    light("-5,3,2", 0.25, 0.3, 0.4, 0)
    material("mirror", "0.3,0.28,0.2", ", \"specular\": 0.4, \"shininess\": 40, \"reflection\": [0.5, 0.55, 0.6]",
        "specular 0.4 roughness 1/40 reflection { rgb <0.5,0.55,0.6> }")
    material("ground", "0.6,0.45,0.3")
    object("{\"shape\": \"plane\", \"size\": 12, \"translation\": [0, -1.2, 0], \"material\": \"ground\"}")
    print "mesh { triangle { <-6,-1.2,-6>,<6,-1.2,-6>,<6,-1.2,6> } triangle { <-6,-1.2,-6>,<6,-1.2,6>,<-6,-1.2,6> } texture { M_ground } }" > pov
    flake(0, 0, 0, 1, 0, 1, 0, 2)
    finish()
}

# --- glass: a ball of index 1.5 before another one, over squares ---

function glass_scene() {
    begin("0.4,1.9,5.5", "0,0.9,0", 34, "0.25,0.4,0.7")
    light("-3,6,4", 40, 38, 36, 1)
    floor_of_squares(16, 0, 230, 60)
    if (mode == "colors") {
        materials = materials ",\n  \"glass\": {\"diffuse\": 0, \"ambient\": 0, \"transmission\": 1, \"ior\": 1.5, \"specular\": 0.6, \"shininess\": 100}"
        print "#declare M_glass = texture { pigment { rgbf 1 } finish { ambient 0 diffuse 0 specular 0.6 roughness 1/100 reflection { 1 fresnel on } conserve_energy } }" > pov
    }
    material("clay", "0.7,0.25,0.15", ", \"specular\": 0.3, \"shininess\": 20", "specular 0.3 roughness 1/20")
    ball(0.3, 1.05, 0.8, 0.9, "glass", mode == "masks" ? "" : "interior { ior 1.5 }")
    ball(-1.5, 0.75, -1.2, 0.7, "clay")
    finish()
}

# --- hollow: a hollow ball of glass, before one of clay ---

function clear(id, ior, more) {
    materials = materials sprintf(",\n  \"%s\": {\"diffuse\": 0, \"ambient\": 0, \"transmission\": 1, \"ior\": %g%s}", id, ior, more)
    printf "#declare M_%s = texture { pigment { rgbf 1 } finish { ambient 0 diffuse 0 reflection { 1 fresnel on } conserve_energy } }\n", id > pov
}
function hollow_scene() {
    begin("0.2,2.1,5.5", "0,0.8,0", 34, "0.25,0.4,0.7")
    light("-3,6,4", 40, 38, 36, 1)
    floor_of_squares(16, 0, 230, 60)
    # For POV-Ray a difference of balls; for whit a ball of air, which has priority.
    if (mode == "colors") {
        clear("glass", 1.5)
        clear("air", 1, ", \"priority\": 1")
        ball(-0.6, 1, 0.5, 0.7, "air", "", 1)
        print "difference { sphere { <-0.6,1,0.5>,0.9 } sphere { <-0.6,1,0.5>,0.7 } texture { M_glass } interior { ior 1.5 } }" > pov
    }
    ball(-0.6, 1, 0.5, 0.9, "glass", "", mode == "colors")
    material("clay", "0.7,0.25,0.15", ", \"specular\": 0.3, \"shininess\": 20", "specular 0.3 roughness 1/20")
    ball(0.9, 0.8, -0.8, 0.8, "clay")
    finish()
}

# --- wine: a ball that absorbs, and its shadow ---
# With two bounces: POV-Ray does not absorb what is reflected inside.

function wine_scene() {
    begin("0.2,2.1,5.5", "0,0.8,0", 34, "0.25,0.4,0.7")
    light("-3,6,4", 40, 38, 36, 1)
    floor_of_squares(16, 0, 230, 60)
    if (mode == "colors")
        clear("wine", 1.33, ", \"absorption\": [0.3, 1.4, 1]")
    # Beer: exp((fade_color - 1) depth / fade_distance), from a fade_power of 1000 on
    ball(0, 1, 0.4, 0.9, "wine", "interior { ior 1.33 fade_power 1001 fade_distance 0.5 fade_color rgb <0.85,0.3,0.5> }")
    finish()
}

# --- mesh: a wavy ring of triangles under two lights ---

function point(u, v,    a, b, r) {
    a = u * 2 * atan2(0, -1) / us; b = v * 2 * atan2(0, -1) / vs
    r = 0.42 + 0.08 * sin(5 * a)
    x = (1.2 + r * cos(b)) * cos(a); y = r * sin(b); z = (1.2 + r * cos(b)) * sin(a)
}
function mesh_scene(    u, v, i, obj, corner, list) {
    us = 96; vs = 40
    begin("0,2.6,3.6", "0,-0.1,0", 42, "0.02,0.03,0.05")
    light("3,4,2", 18, 16, 13, 1)
    light("-4,3,1", 0.2, 0.3, 0.5, 0)
    material("ring", "0.75,0.5,0.35", ", \"specular\": 0.35, \"shininess\": 25", "specular 0.35 roughness 1/25")
    material("ground", "0.5,0.55,0.5")
    object("{\"shape\": \"plane\", \"size\": 10, \"translation\": [0, -0.6, 0], \"material\": \"ground\"}")
    print "mesh { triangle { <-5,-0.6,-5>,<5,-0.6,-5>,<5,-0.6,5> } triangle { <-5,-0.6,-5>,<5,-0.6,5>,<-5,-0.6,5> } texture { M_ground } }" > pov
    obj = json; sub(/json$/, "obj", obj)
    for (v = 0; v < vs; v++)
        for (u = 0; u < us; u++) {
            point(u, v)
            printf "v %.7f %.7f %.7f\n", x, y, z > obj
            list[u, v] = sprintf("<%.7f,%.7f,%.7f>", x, y, z)
        }
    print "mesh {" > pov
    for (v = 0; v < vs; v++)
        for (u = 0; u < us; u++) {
            i = (u + 1) % us; corner = (v + 1) % vs
            printf "f %d %d %d\nf %d %d %d\n", v * us + u + 1, corner * us + u + 1, corner * us + i + 1,
                v * us + u + 1, corner * us + i + 1, v * us + i + 1 > obj
            printf "triangle { %s,%s,%s }\ntriangle { %s,%s,%s }\n", list[u, v], list[u, corner], list[i, corner],
                list[u, v], list[i, corner], list[i, v] > pov
        }
    print "texture { M_ring } }" > pov
    sub(/.*\//, "", obj)
    object("{\"model\": \"" obj "\", \"material\": \"ring\"}")
    finish()
}

BEGIN {
    if (name == "flake") flake_scene()
    else if (name == "glass") glass_scene()
    else if (name == "hollow") hollow_scene()
    else if (name == "wine") wine_scene()
    else if (name == "mesh") mesh_scene()
    else exit 2
}'
