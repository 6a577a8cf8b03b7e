// The one piece of C++: SPIRV-Tools' optimizer has no C interface.
#include "device/specialize.h"

#include <cstdlib>
#include <cstring>
#include <exception>
#include <unordered_map>
#include <vector>

#include <spirv-tools/optimizer.hpp>

namespace
{

std::vector<uint32_t> run(const uint32_t *words, size_t word_count, const uint32_t *spec,
                          uint32_t spec_count)
{
    std::unordered_map<uint32_t, std::vector<uint32_t>> values;
    for (uint32_t i = 0; i < spec_count; ++i)
        values[i] = {spec[i]};
    spvtools::Optimizer optimizer(SPV_ENV_VULKAN_1_2);
    // Nothing that moves or merges arithmetic: branches that constants decide, and what then is
    // never reached or used.
    optimizer.RegisterPass(spvtools::CreateSetSpecConstantDefaultValuePass(values))
        .RegisterPass(spvtools::CreateFreezeSpecConstantValuePass())
        .RegisterPass(spvtools::CreateFoldSpecConstantOpAndCompositePass())
        .RegisterPass(spvtools::CreateDeadBranchElimPass())
        .RegisterPass(spvtools::CreateBlockMergePass())
        .RegisterPass(spvtools::CreateEliminateDeadFunctionsPass())
        .RegisterPass(spvtools::CreateAggressiveDCEPass());
    spvtools::OptimizerOptions options;
    options.set_run_validator(false); // the build validates every variant
    std::vector<uint32_t> result;
    if (!optimizer.Run(words, word_count, &result, options))
        result.clear();
    return result;
}

} // namespace

bool spirv_specialize(const uint32_t *words, size_t word_count, const uint32_t *spec,
                      uint32_t spec_count, uint32_t **out, size_t *out_words)
try {
    const std::vector<uint32_t> result = run(words, word_count, spec, spec_count);
    *out = result.empty() ? nullptr
                          : static_cast<uint32_t *>(std::malloc(result.size() * sizeof result[0]));
    if (!*out)
        return false;
    std::memcpy(*out, result.data(), result.size() * sizeof result[0]);
    *out_words = result.size();
    return true;
} catch (const std::exception &) {
    return false;
}
