#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>

#include "core/error.h"
#include "io/npz_volume.h"

/// Input: a .npz file with an array "mask".
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    try {
        const stipple::NpyVolume volume =
            stipple::parse_npz_volume(std::span(data, size), "fuzz.npz", "mask");
        const auto values = static_cast<std::size_t>(volume.layers) *
                            static_cast<std::size_t>(volume.rows) *
                            static_cast<std::size_t>(volume.cols);
        if (values != volume.values.size()) std::abort();
    } catch (const stipple::InputError&) {
    }
    return 0;
}
