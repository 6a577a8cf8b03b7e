// Changes the surface that a ray has hit, before textures and material apply: for bumps and patterns.
//
// s: struct Surface. Read afterwards are ns (the shading normal; need not be unit), color (the
//    material's color is multiplied by it), color_alpha, u and v.
void surface(inout Surface s)
{
}
