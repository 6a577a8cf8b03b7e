/* Edges are where neighbouring pixels hit something else. */
#include "image_fixture.h"

#include "image/edges.h"

enum { WIDTH = 4, HEIGHT = 3, COUNT = WIDTH * HEIGHT };

/* Instances and primitives are given as rows of digits; `wanted` has an x for each black pixel. */
static void assert_edges(const char *instances, const char *primitives, bool of_primitives,
                         const char *wanted)
{
    own_image color = fixture_flat(WIDTH, HEIGHT, 4, 2.5f);
    own_image ids = fixture_words(WIDTH, HEIGHT, 2);
    for (size_t i = 0; i < COUNT; ++i) {
        ids.words[2 * i] = (uint32_t)instances[i];
        ids.words[2 * i + 1] = (uint32_t)primitives[i];
    }
    image_draw_edges(&color, &ids, of_primitives);
    for (size_t i = 0; i < COUNT; ++i) {
        float light = wanted[i] == 'x' ? 0.0f : 2.5f;
        for (size_t c = 0; c < 3; ++c)
            assert_float_equal(color.pixels[4 * i + c], light, 0.0f);
        assert_float_equal(color.pixels[4 * i + 3], 2.5f, 0.0f);
    }
}

TEST(edges_are_of_objects_or_of_primitives)
{
    assert_edges("000000000000", "000000000000", true, "............");
    assert_edges("0011"
                 "0011"
                 "0011",
                 "0100"
                 "0100"
                 "0100",
                 false,
                 ".x.."
                 ".x.."
                 ".x..");
    assert_edges("0011"
                 "0011"
                 "0011",
                 "0100"
                 "0100"
                 "0122",
                 true,
                 "xx.."
                 "xxxx"
                 "xx..");
}

/* Pixels in the last column and row have no neighbour there, not even the one next in memory. */
TEST(edges_of_the_picture_are_none)
{
    assert_edges("0000"
                 "1111"
                 "1111",
                 "000000000000", false,
                 "xxxx"
                 "...."
                 "....");
    assert_edges("0001"
                 "0001"
                 "0001",
                 "000000000000", false,
                 "..x."
                 "..x."
                 "..x.");
}
