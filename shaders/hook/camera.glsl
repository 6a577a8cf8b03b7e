// The ray of a pixel's sample.
//
// at:     place in the picture, -1 to 1 from left to right and from top to bottom
// origin: where the ray starts, world space; comes as the scene's camera has it
// dir:    the way it goes, of any length above 0; comes as the scene's camera has it
void camera(vec2 at, inout vec3 origin, inout vec3 dir)
{
}
