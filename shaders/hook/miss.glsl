// The light that a ray sees where it hits nothing.
//
// dir: the ray's direction, unit, world space
// gives: radiance, linear RGB
vec3 miss(vec3 dir)
{
    return environment(dir);
}
