//@ whit 1
// Contour lines, as on a map: a line wherever the height crosses a multiple of a step.
//@ slider spacing 0.02 5 0.25 "world units between lines"
//@ slider thick 0.5 4 1.2 "pixels that a line is thick"
//@ color ink #1a3050 "of the lines"

vec3 shade(Surface s, Optics o, vec3 to_eye)
{
    // World units that a pixel covers at this distance, along the slope.
    float pixel_size = ray_distance() * 1.2 / float(picture_size().y);
    float slope = sqrt(max(1.0 - s.ng.y * s.ng.y, 0.0));
    float height = s.p.y / spacing;
    float near = abs(height - round(height)) * spacing;
    float line = 1.0 - smoothstep(0.5, 1.0, near / max(thick * pixel_size * slope, 1e-6));
    return mix(whit_shade(s, o, to_eye), ink, slope > 0.05 ? line : 0.0);
}
