#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/geometry.h"
#include "io/png_file.h"

namespace stipple {

/// A frame of n times as many rows and columns, order (plane, row, col), by a sinc with the window
/// of Lanczos, of 6 x 6 pixels. Beyond the borders light is that of the nearest pixel; negative
/// light becomes 0. A linear interpolation of signals in light, without a model of scenes or noise.
[[nodiscard]] std::vector<float> enlarged_frame(std::span<const float> frame, FrameShape shape,
                                                int n);

/// A slot of a trial in four tiles side by side: truth, naive, decoded, error.
class TrialPicture {
  public:
    static constexpr int kTiles = 4;
    static constexpr int kMaxRows = 120;  ///< of a tile; of larger frames the middle is shown
    static constexpr int kMaxCols = 160;

    enum Tile : std::uint8_t { kTruth, kNaive, kDecoded, kError };

    /// Black.
    explicit TrialPicture(FrameShape frame);

    /// A tile of light by the tone curve of io/tone_map.h. `frame` has the shape of the frame.
    void put(Tile tile, std::span<const float> frame);
    /// The tile of `decoded` - `truth`, mean of the colours, as grey: 128 is none, 255 is
    /// kErrorRange or more too bright, 0 so much too dark.
    void put_error(std::span<const float> decoded, std::span<const float> truth);

    static constexpr float kErrorRange = 0.25F;  ///< light

    [[nodiscard]] const PngPixels& pixels() const { return pixels_; }

  private:
    [[nodiscard]] std::span<std::uint8_t> tile_row(Tile tile, int row);

    FrameShape frame_;
    PngPixels pixels_;
};

}  // namespace stipple
