#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <vector>

#include "calibration/calibration_file.h"
#include "core/error.h"
#include "stream/crc32c.h"
#include "stream/little_endian.h"

/// Input: a calibration file without its CRC, which is appended. What is accepted is written as the
/// same bytes.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace stipple;
    std::vector<std::uint8_t> bytes(data, data + size);
    append(bytes, crc32c(bytes));
    try {
        const ChipCalibration calibration = decode_chip_calibration(bytes, "fuzz");
        if (encode_chip_calibration(calibration) != bytes) std::abort();
    } catch (const InputError&) {
        return 0;
    }
    return 0;
}
