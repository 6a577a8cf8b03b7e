// A value beside the colour: `//@ aov NAME` stands before a function NAME, of which a file may have 64.
// It is called for what a camera ray hits first. A pixel has the mean of its samples; a sample that
// hits nothing counts as 0. An EXR has it as NAME.R, .G, .B and .A, and --aov NAME shows it.
//
// s:     struct Surface, as in shade()
// gives: four numbers of any meaning, which are not clamped
//@ aov normals
vec4 normals(Surface s)
{
    return vec4(0.5 + 0.5 * s.ns, 1.0);
}
