#include "shader/disassemble.h"

#include <spirv-tools/libspirv.h>

#include "base/array.h"

char *shader_disassemble(const uint32_t *words, size_t bytes)
{
    const uint32_t options = SPV_BINARY_TO_TEXT_OPTION_INDENT;
    spv_context context = spvContextCreate(SPV_ENV_VULKAN_1_2);
    spv_text text = NULL;
    bool fine = spvBinaryToText(context, words, bytes / 4, options, &text, NULL) == SPV_SUCCESS;
    char *copy = fine ? string_copy(text->str) : NULL;
    spvTextDestroy(text);
    spvContextDestroy(context);
    return copy;
}
