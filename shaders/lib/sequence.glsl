// The sequence of samples, the same as in host/picture/sequence.c, which says what it must fulfil.
#ifndef LIB_SEQUENCE_GLSL
#define LIB_SEQUENCE_GLSL

// The digits of the second coordinate of point `index`, the lowest bit first; those of the first coordinate
// are the index itself.
uint sequence_rows(uint index)
{
    index ^= (index >> 1) & 0x55555555u;
    index ^= (index >> 2) & 0x33333333u;
    index ^= (index >> 4) & 0x0f0f0f0fu;
    index ^= (index >> 8) & 0x00ff00ffu;
    return index ^ (index >> 16);
}

uint sequence_place(uint digits, uvec2 turns)
{
    uint flips = (digits & 63u) != 0u ? 0x55555541u : 1u;
    flips |= ((turns.x >> (4u + (digits & 3u))) & 1u) << 2;
    flips |= ((turns.x >> (8u + (digits & 7u))) & 1u) << 3;
    flips |= ((turns.x >> (16u + (digits & 15u))) & 1u) << 4;
    flips |= ((turns.y >> (digits & 31u)) & 1u) << 5;
    return bitfieldReverse(digits ^ flips);
}

// Point `index` of the sequence, in units of 2^-32.
uvec2 sequence_point(uint index)
{
    return uvec2(sequence_place(index, uvec2(0x026472e0u, 0x21a3e51au)),
                 sequence_place(sequence_rows(index), uvec2(0x372c3e00u, 0x087cd066u)));
}

#endif
