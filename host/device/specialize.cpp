// The one piece of C++: SPIRV-Tools' optimizer has no C interface.
#include "device/specialize.h"

#include <cstdlib>
#include <cstring>
#include <exception>
#include <unordered_map>
#include <vector>

#include <spirv-tools/libspirv.h>
#include <spirv-tools/optimizer.hpp>

namespace
{

// Empty when a pass refuses.
std::vector<uint32_t> run(spvtools::Optimizer &optimizer, const uint32_t *words, size_t word_count)
{
    // Without a consumer its remarks would be exceptions; a failure is the caller's to report.
    optimizer.SetMessageConsumer(
        [](spv_message_level_t, const char *, const spv_position_t &, const char *) {});
    spvtools::OptimizerOptions options;
    options.set_run_validator(false); // the build validates every variant
    std::vector<uint32_t> result;
    if (!optimizer.Run(words, word_count, &result, options))
        result.clear();
    return result;
}

std::vector<uint32_t> specialize(const uint32_t *words, size_t word_count, const uint32_t *spec,
                                 uint32_t spec_count)
{
    std::unordered_map<uint32_t, std::vector<uint32_t>> values;
    for (uint32_t i = 0; i < spec_count; ++i)
        values[i] = {spec[i]};
    spvtools::Optimizer optimizer(SPV_ENV_VULKAN_1_2);
    // Nothing that moves or merges arithmetic: branches that constants decide, and what then is
    // never reached or used. Names go first: passes look after every one of them.
    optimizer.RegisterPass(spvtools::CreateStripDebugInfoPass())
        .RegisterPass(spvtools::CreateSetSpecConstantDefaultValuePass(values))
        .RegisterPass(spvtools::CreateFreezeSpecConstantValuePass())
        .RegisterPass(spvtools::CreateFoldSpecConstantOpAndCompositePass())
        .RegisterPass(spvtools::CreateDeadBranchElimPass())
        .RegisterPass(spvtools::CreateBlockMergePass())
        .RegisterPass(spvtools::CreateEliminateDeadFunctionsPass());
    // The same for branches on what variables hold, such as `bool stacked = SPEC_SECONDARY != 0u &&
    // ...`: variables become values, of which some are constants now. Operations with NoContraction
    // are not folded.
    optimizer.RegisterPass(spvtools::CreateLocalSingleBlockLoadStoreElimPass())
        .RegisterPass(spvtools::CreateLocalSingleStoreElimPass())
        .RegisterPass(spvtools::CreateAggressiveDCEPass())
        .RegisterPass(spvtools::CreateSSARewritePass())
        .RegisterPass(spvtools::CreateCCPPass())
        .RegisterPass(spvtools::CreateDeadBranchElimPass())
        .RegisterPass(spvtools::CreateBlockMergePass())
        .RegisterPass(spvtools::CreateEliminateDeadFunctionsPass())
        .RegisterPass(spvtools::CreateAggressiveDCEPass());
    return run(optimizer, words, word_count);
}

// malloc()ed, for C; false when there is nothing, or no memory.
bool hand_over(const std::vector<uint32_t> &words, uint32_t **out, size_t *out_words)
{
    *out = words.empty() ? nullptr
                         : static_cast<uint32_t *>(std::malloc(words.size() * sizeof words[0]));
    if (!*out)
        return false;
    std::memcpy(*out, words.data(), words.size() * sizeof words[0]);
    *out_words = words.size();
    return true;
}

// Words of the specification (SPIR-V 1.5, 3.32 and 3.20).
enum { OP_FUNCTION = 54, OP_FUNCTION_END = 56, OP_DECORATE = 71, DECORATION_BINDING = 33 };

struct inspection {
    std::unordered_map<uint32_t, uint32_t> bindings; // of variables
    spirv_info info;
    bool in_function;
};

spv_result_t inspect_instruction(void *user, const spv_parsed_instruction_t *instruction)
{
    inspection &seen = *static_cast<inspection *>(user);
    const uint32_t *words = instruction->words;
    if (instruction->opcode == OP_DECORATE && words[2] == DECORATION_BINDING)
        seen.bindings[words[1]] = words[3];
    seen.in_function = seen.in_function || instruction->opcode == OP_FUNCTION;
    if (!seen.in_function)
        return SPV_SUCCESS;
    ++seen.info.instructions;
    for (uint16_t i = 0; i < instruction->num_operands; ++i) {
        const spv_parsed_operand_t &operand = instruction->operands[i];
        const auto binding = operand.type == SPV_OPERAND_TYPE_ID
                                 ? seen.bindings.find(words[operand.offset])
                                 : seen.bindings.end();
        if (binding != seen.bindings.end() && binding->second < 64)
            seen.info.bindings |= UINT64_C(1) << binding->second;
    }
    seen.in_function = instruction->opcode != OP_FUNCTION_END;
    return SPV_SUCCESS;
}

} // namespace

const char *spirv_tools_version(void)
{
    return spvSoftwareVersionString();
}

bool spirv_inspect(const uint32_t *words, size_t word_count, struct spirv_info *out)
try {
    inspection seen = {};
    const spv_context context = spvContextCreate(SPV_ENV_VULKAN_1_2);
    const spv_result_t result =
        spvBinaryParse(context, &seen, words, word_count, nullptr, inspect_instruction, nullptr);
    spvContextDestroy(context);
    *out = seen.info;
    return result == SPV_SUCCESS;
} catch (const std::exception &) {
    return false;
}

bool spirv_specialize(const uint32_t *words, size_t word_count, const uint32_t *spec,
                      uint32_t spec_count, uint32_t **out, size_t *out_words)
try {
    return hand_over(specialize(words, word_count, spec, spec_count), out, out_words);
} catch (const std::exception &) {
    return false;
}
