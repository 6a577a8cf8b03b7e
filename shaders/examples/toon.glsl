//@ whit 1
// Light in a few steps, with a bright rim, as in a drawing.
//@ slider bands 1 8 3 "steps of light"
//@ color rim #ffcc88 "colour where the surface turns away"
//@ slider width 0 1 0.35 "how far the rim reaches in"

vec3 shade(Surface s, Optics o, vec3 to_eye)
{
    float lit = 0.15;
    for (uint i = 0u; i < light_count(); i++) {
        Light l = light(i, 0u, s);
        if (l.arriving != vec3(0.0))
            lit += max(dot(s.ns, l.dir), 0.0) * visible(s, l.dir, l.distance).g;
    }
    float steps = ceil(min(lit, 1.0) * bands) / bands;
    vec3 paint = max(o.diffuse, 0.7 * (o.reflected + o.refracted)); // of mirrors and glass too
    float edge = (1.0 - abs(dot(s.ns, to_eye))) * (1.0 - s.ng.y * s.ng.y); // floors have no rim
    return mix(paint * steps, rim, smoothstep(1.0 - width, 1.0 - 0.8 * width, edge));
}

// Nothing is mirrored or let through.
void scatter(Surface s, Optics o, inout Rays rays)
{
}
