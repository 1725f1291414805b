#include "capture/serve/gvsp_sender.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <utility>

#include "capture/serve/big_endian.h"

namespace stipple {
namespace {

/// Leaves the region of `settings` in `payload`. Offsets are whole bytes (gige_width_step).
void crop(std::vector<std::uint8_t>& payload, const ServedImage& image,
          const GigeStreamSettings& settings) {
    const std::size_t from_stride = settings.format->row_bytes(image.width);
    const std::size_t to_stride = settings.format->row_bytes(static_cast<int>(settings.width));
    const std::size_t left = settings.format->row_bytes(static_cast<int>(settings.offset_x));
    for (std::uint32_t row = 0; row < settings.height; ++row) {
        const std::size_t from = (row + settings.offset_y) * from_stride + left;
        std::copy_n(payload.begin() + static_cast<std::ptrdiff_t>(from), to_stride,
                    payload.begin() + static_cast<std::ptrdiff_t>(row * to_stride));
    }
    payload.resize(settings.height * to_stride);
}

void add_chunks(std::vector<std::uint8_t>& payload, const GigeStreamSettings& settings,
                const std::array<std::uint64_t, gige::kChunkTypes>& values) {
    close_chunk(payload, gige::kImageChunkId, payload.size());
    for (std::size_t i = 0; i < gige::kChunkTypes; ++i) {
        if (!settings.chunks[i]) continue;
        const gige::Chunk& chunk = gige::kChunks[i];
        if (chunk.bytes == 8) append_be(payload, values[i]);
        if (chunk.bytes == 4) append_be(payload, static_cast<std::uint32_t>(values[i]));
        close_chunk(payload, chunk.id, chunk.bytes);
    }
}

}  // namespace

GvspBlock served_block(ServedFrame frame, const ServedImage& image,
                       const GigeStreamSettings& settings, std::uint64_t timestamp_ns) {
    assert(frame.payload.size() ==
           settings.format->row_bytes(image.width) * static_cast<std::size_t>(image.height));
    GvspBlock block;
    block.timestamp = timestamp_ns;
    block.image = {settings.format->pfnc, settings.width, settings.height, settings.offset_x,
                   settings.offset_y};
    block.has_chunks = settings.chunk_mode;
    block.piece_bytes = settings.packet_bytes - kGvspOverheadBytes;
    block.payload = std::move(frame.payload);
    const bool whole = static_cast<int>(settings.width) == image.width &&
                       static_cast<int>(settings.height) == image.height;
    if (!whole) crop(block.payload, image, settings);
    if (block.has_chunks)
        add_chunks(block.payload, settings, {frame.number, image.exposure_map_id, timestamp_ns});
    return block;
}

}  // namespace stipple
