#include "study/explore/trial.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>

#include "core/index.h"
#include "io/tone_map.h"

namespace stipple {
namespace {

constexpr int kLobes = 3;

/// The window of Lanczos: sinc(x) sinc(x / 3).
double lanczos(double x) {
    if (x == 0) return 1;
    if (std::abs(x) >= kLobes) return 0;
    const double angle = std::numbers::pi * x;
    return kLobes * std::sin(angle) * std::sin(angle / kLobes) / (angle * angle);
}

/// Pixels of a line, and their weights.
struct Taps {
    std::array<std::size_t, 2 * kLobes> pixel;
    std::array<double, 2 * kLobes> weight;
};

/// Of each of n * count pixels.
std::vector<Taps> taps_of(int count, int n) {
    std::vector<Taps> taps;
    for (int i = 0; i < n * count; ++i) {
        const double place = (i + 0.5) / n - 0.5;
        const int first = static_cast<int>(std::floor(place)) - kLobes + 1;
        Taps of_pixel{};
        double sum = 0;
        for (int k = 0; k < 2 * kLobes; ++k) {
            of_pixel.pixel[index(k)] = index(std::clamp(first + k, 0, count - 1));
            sum += of_pixel.weight[index(k)] = lanczos(place - (first + k));
        }
        for (double& weight : of_pixel.weight) weight /= sum;
        taps.push_back(of_pixel);
    }
    return taps;
}

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

std::vector<float> enlarged_frame(std::span<const float> frame, FrameShape shape, int n) {
    const std::vector<Taps> rows = taps_of(shape.rows, n);
    const std::vector<Taps> cols = taps_of(shape.cols, n);
    std::vector<float> enlarged;
    enlarged.reserve(rows.size() * cols.size() * index(shape.planes));
    std::vector<double> line(index(shape.cols));
    for (int plane = 0; plane < shape.planes; ++plane) {
        const auto light = frame.subspan(index(plane) * shape.pixels(), shape.pixels());
        for (const Taps& row : rows) {
            for (std::size_t col = 0; col < line.size(); ++col) {
                line[col] = 0;
                for (std::size_t k = 0; k < row.pixel.size(); ++k)
                    line[col] += row.weight[k] *
                                 static_cast<double>(light[row.pixel[k] * line.size() + col]);
            }
            for (const Taps& col : cols) {
                double sum = 0;
                for (std::size_t k = 0; k < col.pixel.size(); ++k)
                    sum += col.weight[k] * line[col.pixel[k]];
                enlarged.push_back(std::max(static_cast<float>(sum), 0.0F));
            }
        }
    }
    return enlarged;
}

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
