// Which rays go on from a surface, their directions, and how much of the light that they bring is seen.
//
// s, o: as in shade()
// rays: struct Rays; has no rays at first
void scatter(Surface s, Optics o, inout Rays rays)
{
    float solid = 1.0 - o.straight; // the share that does not pass straight through
    rays.straight = vec3(o.straight);
    rays.reflected = o.reflected * solid;
    rays.reflected_dir = reflect(ray_dir(), s.ns);
    rays.refracted_dir = ray_dir();
    if (o.thin || refract_dir(ray_dir(), s.ns, o.eta, rays.refracted_dir))
        rays.refracted = o.refracted * solid;
}
