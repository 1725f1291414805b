#include "explore/trial_picture.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "core/index.h"
#include "io/tone_map.h"

namespace stipple {
namespace {

FrameShape shown(FrameShape frame) {
    return {.rows = std::min(frame.rows, TrialPicture::kMaxRows),
            .cols = std::min(frame.cols, TrialPicture::kMaxCols),
            .planes = frame.planes};
}

/// Index of the value of a frame that the tile shows at (row, col).
std::size_t index_of(FrameShape frame, int plane, int row, int col) {
    const FrameShape tile = shown(frame);
    const std::size_t at_row = index((frame.rows - tile.rows) / 2 + row);
    const std::size_t at_col = index((frame.cols - tile.cols) / 2 + col);
    return static_cast<std::size_t>(plane) * frame.pixels() +
           at_row * static_cast<std::size_t>(frame.cols) + at_col;
}

std::uint8_t grey_of_error(float error) {
    const float level = 128 + 127 * error / TrialPicture::kErrorRange;
    return static_cast<std::uint8_t>(std::lround(std::clamp(level, 0.0F, 255.0F)));
}

}  // namespace

TrialPicture::TrialPicture(FrameShape frame) : frame_(frame) {
    const FrameShape tile = shown(frame);
    pixels_ = {.rows = tile.rows,
               .cols = kTiles * tile.cols,
               .channels = tile.planes,
               .bytes = std::vector<std::uint8_t>(kTiles * tile.sites())};
}

std::span<std::uint8_t> TrialPicture::tile_row(Tile tile, int row) {
    const FrameShape shape = shown(frame_);
    const auto width = index(shape.cols * shape.planes);
    return std::span(pixels_.bytes)
        .subspan((static_cast<std::size_t>(row) * kTiles + tile) * width, width);
}

void TrialPicture::put(Tile tile, std::span<const float> frame) {
    const FrameShape shape = shown(frame_);
    for (int row = 0; row < shape.rows; ++row) {
        auto to = tile_row(tile, row).begin();
        for (int col = 0; col < shape.cols; ++col)
            for (int plane = 0; plane < shape.planes; ++plane)
                *to++ = tone_mapped(frame[index_of(frame_, plane, row, col)]);
    }
}

void TrialPicture::put_error(std::span<const float> decoded, std::span<const float> truth) {
    const FrameShape shape = shown(frame_);
    for (int row = 0; row < shape.rows; ++row) {
        auto to = tile_row(kError, row).begin();
        for (int col = 0; col < shape.cols; ++col) {
            float sum = 0;
            for (int plane = 0; plane < shape.planes; ++plane) {
                const std::size_t i = index_of(frame_, plane, row, col);
                sum += decoded[i] - truth[i];
            }
            to = std::fill_n(to, shape.planes,
                             grey_of_error(sum / static_cast<float>(shape.planes)));
        }
    }
}

}  // namespace stipple
