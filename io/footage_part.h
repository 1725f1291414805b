#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/colour_filter.h"
#include "core/geometry.h"
#include "core/plane.h"

namespace stipple {

/// Each pixel of `to` becomes the mean light of the area that it covers in `from`, whose pixels at
/// the borders count by their share. So the mean of the plane is kept, and no light is negative.
/// Precondition: `to` has at least one row and column, and no more of either than `from`.
void average_areas(PlaneView<const float> from, PlaneView<float> to);

/// Frames from `begin` on, before `end`.
struct FrameRange {
    int begin = 0;
    std::optional<int> end = {};  ///< none: that of the footage

    bool operator==(const FrameRange&) const = default;
};

/// A rectangle of pixels; without a corner the middle of the frame.
struct CropArea {
    int rows = 0;
    int cols = 0;
    struct Corner {
        int row = 0;
        int col = 0;
        bool operator==(const Corner&) const = default;
    };
    std::optional<Corner> corner = {};

    bool operator==(const CropArea&) const = default;
};

/// The part of footage that is read, and its resolution. A frame is cropped, then binned, then
/// resized.
struct FootagePart {
    static constexpr int kMaxBin = 64;

    FrameRange frames = {};
    std::optional<CropArea> crop = {};
    int bin = 1;                          ///< mean light of bin x bin pixels
    std::optional<FrameShape> size = {};  ///< rows and columns; none: those it has

    /// Whether frames stay as they are.
    [[nodiscard]] bool has_whole_frames() const { return !crop && bin == 1 && !size; }
    bool operator==(const FootagePart&) const = default;
};

/// "A:B", of which A or B may be missing. \throws InputError saying what is wrong.
[[nodiscard]] FrameRange parse_frame_range(const std::string& text);
/// "WxH+X+Y" or "WxH". \throws InputError saying what is wrong.
[[nodiscard]] CropArea parse_crop_area(const std::string& text);
/// As parse_frame_range and parse_crop_area read it.
[[nodiscard]] std::string text_of(const FrameRange& frames);
[[nodiscard]] std::string text_of(const CropArea& area);

/// Makes frames of the part of whole ones.
class FrameReduction {
  public:
    /// Frames of `source`, which messages call `name`. \throws InputError if the part does not fit
    /// into them, would enlarge them, or would mix the colours of a mosaic.
    FrameReduction(const FootagePart& part, FrameShape source, ColourFilter mosaic,
                   const std::string& name);

    [[nodiscard]] FrameShape shape() const { return resized_; }
    /// Order (plane, row, col). Precondition: sites of the source and of `shape`.
    void operator()(std::span<const float> frame, std::span<float> reduced);

  private:
    FrameShape source_;
    FrameShape cropped_;
    FrameShape binned_;
    FrameShape resized_;
    CropArea::Corner corner_;
    std::vector<float> crop_;
    std::vector<float> bin_;
};

}  // namespace stipple
