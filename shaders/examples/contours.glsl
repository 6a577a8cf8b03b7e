//@ whit 1
// Contour lines, as on a map: a line wherever the height crosses a multiple of a step. As a value of
// its own (--aov contours: the line, the height, how steep it is), and over the picture.
//@ slider spacing 0.02 5 0.25 "world units between lines"
//@ slider thick 0.5 4 1.2 "pixels that a line is thick"
//@ color ink #1a3050 "of the lines"
//@ toggle drawn on "over the colour"

//@ aov contours
vec4 contours(Surface s)
{
    // World units that a pixel covers at this distance.
    float pixel_size = ray_distance() * 1.2 / float(picture_size().y);
    float slope = sqrt(max(1.0 - s.ng.y * s.ng.y, 0.0));
    float height = s.p.y / spacing;
    float near = abs(height - round(height)) * spacing;
    float line = 1.0 - smoothstep(0.5, 1.0, near / max(thick * pixel_size * slope, 1e-6));
    return vec4(slope > 0.05 ? line : 0.0, s.p.y, slope, 1.0);
}

vec3 shade(Surface s, Optics o, vec3 to_eye)
{
    return mix(whit_shade(s, o, to_eye), ink, drawn ? contours(s).x : 0.0);
}
