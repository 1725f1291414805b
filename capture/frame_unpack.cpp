#include "capture/frame_light.h"

#include <algorithm>
#include <cstddef>

#include "io/pixel_unpack.h"

namespace stipple {

void unpack_frame(const FrameLayout& layout, std::span<const std::uint8_t> payload,
                  std::vector<std::uint16_t>& samples) {
    const PixelFormat& format = *layout.format;
    const auto row_samples =
        static_cast<std::size_t>(layout.width) * static_cast<std::size_t>(format.planes);
    const auto rows = static_cast<std::size_t>(layout.height);
    const std::size_t row_bytes = format.row_bytes(layout.width);
    samples.resize(row_samples * rows);
    std::vector<std::uint8_t> cut;
    for (std::size_t row = 0; row < rows; ++row) {
        std::span<const std::uint8_t> bytes =
            payload.subspan(std::min(payload.size(), row * layout.stride_bytes));
        if (bytes.size() < row_bytes) {
            cut.assign(bytes.begin(), bytes.end());
            cut.resize(row_bytes);
            bytes = cut;
        }
        unpack_row(format, bytes.first(row_bytes),
                   std::span(samples).subspan(row * row_samples, row_samples));
    }
}

}  // namespace stipple
