// A value beside the colour: `//@ aov NAME` stands before a function NAME, of which a file may have 16.
// It is asked for what the camera meets first, the mean of a pixel's samples is kept, and a sample that
// meets nothing counts as 0. An EXR has it as NAME.R, .G, .B and .A, and --aov NAME shows it.
//
// s:     struct Surface, as of shade()
// gives: four numbers of any meaning, which are not clamped
//@ aov normals
vec4 normals(Surface s)
{
    return vec4(0.5 + 0.5 * s.ns, 1.0);
}
