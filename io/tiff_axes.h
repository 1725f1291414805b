#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/message.h"

namespace stipple {

/// What a TIFF file holds: its directories, and the samples of the first one, all channels.
struct TiffExtent {
    std::uint64_t pages = 1;
    std::uint64_t channels = 1;
    std::uint64_t page_samples = 1;
};

/// What a description declares of pages that are moments in time.
struct TiffTimes {
    std::optional<double> frames_hz = {};
    std::vector<Message> warnings = {};  ///< without the name of the file
};

/// Reads the ImageDescription of the first page as ImageJ, OME-XML or tifffile write it; nothing is
/// declared by any other. \throws InputError at `where` if pages are channels, focal planes or
/// others than moments in time, or fewer than the description announces.
[[nodiscard]] TiffTimes times_of_pages(std::string_view description, const TiffExtent& extent,
                                       const std::string& where);

}  // namespace stipple
