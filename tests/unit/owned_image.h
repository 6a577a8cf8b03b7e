/* A picture that is freed at the end of its block: own_image image = ...; */
#ifndef OWNED_IMAGE_H
#define OWNED_IMAGE_H

#include "image/image.h"

#define own_image __attribute__((cleanup(image_finish), unused)) struct image

#endif
