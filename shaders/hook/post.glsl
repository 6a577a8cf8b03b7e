// Changes the colour of a pixel when it has all its samples.
//
// at:    pixel, from 0, 0 at the top left
// color: radiance, linear RGB, the mean of the samples
// gives: the new color, in the same terms
vec3 post(ivec2 at, vec3 color)
{
    return color;
}
