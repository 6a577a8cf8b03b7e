// The ray of a pixel's sample.
//
// at:     place in the picture, -1 to 1 from left to right and from top to bottom
// origin: where the ray starts, world space; at first as in the scene's camera
// dir:    its direction, of any length above 0; at first as in the scene's camera
void camera(vec2 at, inout vec3 origin, inout vec3 dir)
{
}
