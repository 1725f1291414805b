#include <cstdint>

#include "capture/aravis/genicam_description.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static_cast<void>(stipple::unzipped_description({data, size}, 1U << 20U));
    return 0;
}
