#include "sources.h"

#include "shader_sources.h"
