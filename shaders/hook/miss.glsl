// Light from where a ray meets nothing.
//
// dir: unit, world space, the way the ray goes
// gives: radiance, linear RGB
vec3 miss(vec3 dir)
{
    return environment(dir);
}
