#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/error.h"
#include "core/index.h"
#include "decoder/learned/refinement_network.h"
#include "decoder/learned/safetensors.h"
#include "tests/fuzz/require.h"

/// Input: a file of the format safetensors. What passes has the numbers of its shapes, all finite;
/// a network of it refines a picture.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace stipple;
    const std::span bytes(data, size);
    try {
        for (const auto& [name, tensor] : parse_safetensors(bytes, "fuzz").tensors) {
            std::size_t count = 1;
            for (const std::int64_t length : tensor.shape) count *= index(length);
            require(tensor.values.size() == count);
            for (const float value : tensor.values) require(std::isfinite(value));
        }
        const auto network = RefinementNetwork::parse(bytes, "fuzz");
        const std::vector<float> planes(index(network.inputs()) * 3);
        std::vector<float> out(3);
        network.refine(planes, 1, 3, out);
    } catch (const InputError&) {
        return 0;
    }
    return 0;
}
