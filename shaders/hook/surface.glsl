// What a ray has met, before textures and material are looked at: the place for bumps and patterns.
//
// s: struct Surface. What is read afterwards is ns (the shading normal; need not be unit), color (the
//    material's own is multiplied by it), color_alpha, u and v.
void surface(inout Surface s)
{
}
