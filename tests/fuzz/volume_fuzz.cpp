#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>

#include "core/error.h"
#include "io/npy_file.h"
#include "readout/schedules/volume_schedule.h"

namespace stipple {
namespace {

/// Masks of a volume that passes become a schedule of its size.
void import(std::span<const std::byte> bytes, bool lengths) {
    try {
        const NpyVolume volume = parse_npy_volume(bytes, "fuzz.npy");
        if (volume.values.size() > 4096) return;
        const ExposureSchedule schedule =
            lengths ? lengths_schedule(volume, 0, "") : mask_schedule(volume, "");
        if (schedule.tile_rows() != volume.rows || schedule.tile_cols() != volume.cols)
            std::abort();
    } catch (const InputError&) {
    }
}

}  // namespace
}  // namespace stipple

/// Input: a .npy file.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const auto bytes = std::as_bytes(std::span(data, size));
    stipple::import(bytes, false);
    stipple::import(bytes, true);
    return 0;
}
