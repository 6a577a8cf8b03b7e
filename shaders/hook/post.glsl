// The last say over a pixel, when all its samples are in.
//
// at:    pixel, from 0, 0 at the top left
// color: radiance, linear RGB, the mean of the samples
// gives: the same
vec3 post(ivec2 at, vec3 color)
{
    return color;
}
