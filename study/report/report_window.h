#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "core/geometry.h"

namespace stipple {

/// A rectangle of pixels.
struct PixelArea {
    int first_row = 0;
    int first_col = 0;
    int rows = 0;
    int cols = 0;

    bool operator==(const PixelArea&) const = default;
};

/// The most pixels that a report shows unless it is told otherwise.
inline constexpr PixelArea kLargestReportArea{.rows = 480, .cols = 640};

/// The middle of `frame`, with at most so many pixels.
[[nodiscard]] PixelArea middle_area(FrameShape frame, int max_rows, int max_cols);

/// "320x240+100+50": width, height, first column, first row; without a place it lies at (0, 0).
/// Nothing for other texts, and for an area without pixels.
[[nodiscard]] std::optional<PixelArea> parse_area(std::string_view text);

/// The area of `frame` that a report shows: `wanted`, or as much of the middle as
/// kLargestReportArea. \throws InputError if `wanted` does not lie in the frame.
[[nodiscard]] PixelArea report_area(FrameShape frame, const std::optional<PixelArea>& wanted);

/// The values of `area`, order (plane, row, col). Precondition: frame.size() == shape.sites(), and
/// the area lies in it.
[[nodiscard]] std::vector<float> cropped(std::span<const float> frame, FrameShape shape,
                                         const PixelArea& area);

}  // namespace stipple
