// Which rays go on from a surface, which way, and how much of what they bring is seen.
//
// s, o: as of shade()
// rays: struct Rays; comes without rays
void scatter(Surface s, Optics o, inout Rays rays)
{
    float solid = 1.0 - o.straight; // what does not pass undisturbed
    rays.straight = vec3(o.straight);
    rays.reflected = o.reflected * solid;
    rays.reflected_dir = reflect(ray_dir(), s.ns);
    rays.refracted_dir = ray_dir();
    if (o.thin || refract_dir(ray_dir(), s.ns, o.eta, rays.refracted_dir))
        rays.refracted = o.refracted * solid;
}
