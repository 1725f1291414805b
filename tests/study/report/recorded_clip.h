#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/flux_video.h"
#include "readout/sensor_file.h"

namespace stipple {

/// Light from 0 to 3 that differs from site to site and from slot to slot.
inline FluxVideo ramp(int slots, FrameShape shape) {
    FluxVideo video(slots, shape);
    float light = 0;
    for (float& value : video.data()) value = light = std::fmod(light + 0.37F, 3.0F);
    return video;
}

/// A stream of `light` with its provenance.
void record_clip(const std::filesystem::path& file, const SensorChoice& choice,
                 const FluxVideo& light);

/// The values that packed_plane has packed: of zlib's and OpenSSL's readers, and sums.
[[nodiscard]] std::vector<std::uint16_t> unpacked_plane(const std::string& text,
                                                        std::size_t step = 1);

}  // namespace stipple
