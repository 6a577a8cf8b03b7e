// The light that a surface sends to where the ray came from, without what it mirrors or lets through.
//
// s:      struct Surface, turned to the ray's side
// o:      struct Optics: what the material does with light at this place, after textures
// to_eye: unit, world space, from the surface to where the ray came from
// gives:  radiance, linear RGB
vec3 shade(Surface s, Optics o, vec3 to_eye)
{
    if (o.unlit)
        return o.diffuse + o.emission;
    vec3 sum = o.emission + o.ambient * ambient();
    for (uint i = 0u; i < light_count(); i++)
        sum += lit_by(i, s, o, to_eye);
    return sum;
}
