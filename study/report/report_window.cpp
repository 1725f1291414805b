#include "study/report/report_window.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstddef>

#include "core/error.h"

namespace stipple {
namespace {

/// Takes a number from the beginning of `text`.
std::optional<int> take_number(std::string_view& text) {
    int number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc() || number < 0) return std::nullopt;
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    return number;
}

}  // namespace

PixelArea middle_area(FrameShape frame, int max_rows, int max_cols) {
    PixelArea area{.rows = std::min(frame.rows, max_rows), .cols = std::min(frame.cols, max_cols)};
    area.first_row = (frame.rows - area.rows) / 2;
    area.first_col = (frame.cols - area.cols) / 2;
    return area;
}

std::optional<PixelArea> parse_area(std::string_view text) {
    constexpr std::string_view kSeparators = "x++";
    std::array<int, 4> numbers{};
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        const auto number = take_number(text);
        if (!number) return std::nullopt;
        numbers[i] = *number;
        if (text.empty() && (i == 1 || i == 3)) break;
        if (i == 3 || text.empty() || text.front() != kSeparators[i]) return std::nullopt;
        text.remove_prefix(1);
    }
    const auto [cols, rows, first_col, first_row] = numbers;
    if (rows == 0 || cols == 0) return std::nullopt;
    return PixelArea{first_row, first_col, rows, cols};
}

PixelArea report_area(FrameShape frame, const std::optional<PixelArea>& wanted) {
    if (wanted) {
        if (wanted->rows > frame.rows - wanted->first_row ||
            wanted->cols > frame.cols - wanted->first_col)
            throw InputError(
                Parameter{"crop"},
                fmt::format("does not lie in the frame of {} x {} pixels", frame.cols, frame.rows));
        return *wanted;
    }
    return middle_area(frame, kLargestReportArea.rows, kLargestReportArea.cols);
}

std::vector<float> cropped(std::span<const float> frame, FrameShape shape, const PixelArea& area) {
    std::vector<float> values;
    const auto width = static_cast<std::size_t>(area.cols);
    values.reserve(static_cast<std::size_t>(shape.planes) * static_cast<std::size_t>(area.rows) *
                   width);
    for (int plane = 0; plane < shape.planes; ++plane)
        for (int row = area.first_row; row < area.first_row + area.rows; ++row) {
            const std::size_t first =
                static_cast<std::size_t>(plane) * shape.pixels() +
                static_cast<std::size_t>(row) * static_cast<std::size_t>(shape.cols) +
                static_cast<std::size_t>(area.first_col);
            const auto line = frame.subspan(first, width);
            values.insert(values.end(), line.begin(), line.end());
        }
    return values;
}

}  // namespace stipple
