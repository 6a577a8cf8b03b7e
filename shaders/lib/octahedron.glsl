// Maps directions to a square (Meyer et al. 2010) without trigonometry, so that it is the same on
// every device.
#ifndef LIB_OCTAHEDRON_GLSL
#define LIB_OCTAHEDRON_GLSL

// Maps a unit direction to [0, 1]^2; +y is in the middle.
vec2 octahedron_from_dir(vec3 dir)
{
    float size = abs(dir.x) + abs(dir.y) + abs(dir.z);
    vec2 p = dir.xz / size;
    if (dir.y < 0.0)
        p = (1.0 - abs(p.yx)) * vec2(p.x >= 0.0 ? 1.0 : -1.0, p.y >= 0.0 ? 1.0 : -1.0);
    return p * 0.5 + 0.5;
}

#endif
