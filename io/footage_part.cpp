#include "io/footage_part.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "core/error.h"
#include "core/index.h"
#include "core/parallel.h"
#include "core/plane.h"
#include "core/text.h"

namespace stipple {
namespace {

/// A pixel and the length of it that lies in an interval.
struct Share {
    int pixel;
    double length;
};

/// The pixels of the interval `i` of `to` equal ones of `from` pixels. Lengths have the unit 1 / to
/// of a pixel, so that they are whole.
std::vector<Share> shares_of(int i, int from, int to) {
    const std::int64_t begin = std::int64_t{i} * from;
    const std::int64_t end = begin + from;
    std::vector<Share> shares;
    for (std::int64_t pixel = begin / to; pixel * to < end; ++pixel)
        shares.push_back(
            {static_cast<int>(pixel),
             static_cast<double>(std::min(end, (pixel + 1) * to) - std::max(begin, pixel * to))});
    return shares;
}

/// A number of frames or pixels.
std::optional<int> count_of(std::string_view text) {
    constexpr int kMaxCount = 1'000'000'000;
    const auto number = parsed_number<int>(text);
    return number && *number >= 0 && *number <= kMaxCount ? number : std::nullopt;
}

[[noreturn]] void fail_crop(const std::string& text) {
    throw InputError("\"" + text + "\"", "is not WxH or WxH+X+Y in pixels, such as 640x480+16+0");
}

/// The number before `mark`, which is taken off the text with it.
std::optional<int> number_before(char mark, std::string_view& text) {
    const std::size_t end = text.find(mark);
    const auto number = count_of(text.substr(0, end));
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    return number;
}

/// Averages the areas of each plane.
void average_planes(std::span<const float> from, FrameShape source, std::span<float> to,
                    FrameShape shape) {
    for (int plane = 0; plane < source.planes; ++plane)
        average_areas({from.data() + index(plane) * source.pixels(), source.rows, source.cols},
                      {to.data() + index(plane) * shape.pixels(), shape.rows, shape.cols});
}

bool fits(const CropArea& area, const CropArea::Corner& corner, FrameShape source) {
    return area.rows <= source.rows - corner.row && area.cols <= source.cols - corner.col;
}

/// The corner of the middle; of a mosaic even, so that its colours begin alike.
CropArea::Corner middle_of(const CropArea& area, FrameShape source, bool mosaic) {
    CropArea::Corner corner{(source.rows - area.rows) / 2, (source.cols - area.cols) / 2};
    if (mosaic) corner = {corner.row / 2 * 2, corner.col / 2 * 2};
    return corner;
}

}  // namespace

void average_areas(PlaneView<const float> from, PlaneView<float> to) {
    std::vector<std::vector<Share>> cols;
    cols.reserve(index(to.cols()));
    for (int col = 0; col < to.cols(); ++col)
        cols.push_back(shares_of(col, from.cols(), to.cols()));
    const double area = static_cast<double>(from.rows()) * from.cols();
    parallel_for(0, to.rows(), [&](int row) {
        const std::vector<Share> rows = shares_of(row, from.rows(), to.rows());
        for (int col = 0; col < to.cols(); ++col) {
            double light = 0;
            for (const auto& [source_row, height] : rows) {
                const auto line = from.row(source_row);
                for (const auto& [source_col, width] : cols[index(col)])
                    light += height * width * static_cast<double>(line[index(source_col)]);
            }
            to(row, col) = static_cast<float>(light / area);
        }
    });
}

FrameRange parse_frame_range(const std::string& text) {
    const std::size_t colon = text.find(':');
    const auto bound = [&](std::string_view number) -> std::optional<int> {
        if (number.empty()) return std::nullopt;
        if (const auto frame = count_of(number)) return frame;
        throw InputError("\"" + text + "\"",
                         "is not A:B, a first frame and the one after the last");
    };
    if (colon == std::string::npos) static_cast<void>(bound("?"));
    const std::string_view view = text;
    const FrameRange frames{bound(view.substr(0, colon)).value_or(0),
                            bound(view.substr(colon + 1))};
    if (frames.end && *frames.end <= frames.begin)
        throw InputError("\"" + text + "\"", "has no frame: the end is not after the beginning");
    return frames;
}

CropArea parse_crop_area(const std::string& text) {
    std::string_view rest = text;
    const bool has_corner = text.find('+') != std::string::npos;
    const auto cols = number_before('x', rest);
    const auto rows = has_corner ? number_before('+', rest) : count_of(rest);
    if (!cols || !rows || *cols == 0 || *rows == 0) fail_crop(text);
    if (!has_corner) return {*rows, *cols};
    const auto col = number_before('+', rest);
    const auto row = count_of(rest);
    if (!col || !row) fail_crop(text);
    return {*rows, *cols, CropArea::Corner{*row, *col}};
}

std::string text_of(const FrameRange& frames) {
    return fmt::format("{}:{}", frames.begin,
                       frames.end ? std::to_string(*frames.end) : std::string());
}

std::string text_of(const CropArea& area) {
    std::string text = fmt::format("{}x{}", area.cols, area.rows);
    if (area.corner) text += fmt::format("+{}+{}", area.corner->col, area.corner->row);
    return text;
}

FrameReduction::FrameReduction(const FootagePart& part, FrameShape source, ColourFilter mosaic,
                               const std::string& name)
    : source_(source), cropped_(source) {
    const bool is_mosaic = mosaic != ColourFilter::kNone;
    const auto size_text = [](FrameShape shape) {
        return fmt::format("{} x {} pixels", shape.cols, shape.rows);
    };
    if (is_mosaic && (part.bin > 1 || part.size))
        throw InputError(name, "is the mosaic of a colour filter array, whose colours " +
                                   Parameter{part.bin > 1 ? "bin" : "resize"} + " would mix");
    if (part.crop) {
        corner_ = part.crop->corner.value_or(middle_of(*part.crop, source, is_mosaic));
        if (!fits(*part.crop, corner_, source))
            throw InputError(name, fmt::format("has {}, in which ", size_text(source)) +
                                       Parameter{"crop", text_of(*part.crop)} + " does not lie");
        if (is_mosaic && (corner_.row % 2 != 0 || corner_.col % 2 != 0))
            throw InputError(name, "is the mosaic of a colour filter array: " +
                                       Parameter{"crop", text_of(*part.crop)} +
                                       " must begin at an even column and row");
        cropped_ = {part.crop->rows, part.crop->cols, source.planes};
    }
    if (cropped_.rows % part.bin != 0 || cropped_.cols % part.bin != 0)
        throw InputError(
            name,
            fmt::format("has {}, not a multiple of ", size_text(cropped_)) +
                Parameter{"bin", fmt::to_string(part.bin)} + "; add " +
                Parameter{"crop",
                          fmt::format("{}x{}", std::max(cropped_.cols / part.bin, 1) * part.bin,
                                      std::max(cropped_.rows / part.bin, 1) * part.bin)});
    binned_ = {cropped_.rows / part.bin, cropped_.cols / part.bin, source.planes};
    resized_ = part.size ? FrameShape{part.size->rows, part.size->cols, source.planes} : binned_;
    if (resized_.rows > binned_.rows || resized_.cols > binned_.cols)
        throw InputError(
            name, fmt::format("has {}, which ", size_text(binned_)) +
                      Parameter{"resize", fmt::format("{}x{}", resized_.cols, resized_.rows)} +
                      " would enlarge; it only makes frames smaller");
    if (cropped_ != source_) crop_.resize(cropped_.sites());
    if (binned_ != cropped_) bin_.resize(binned_.sites());
}

void FrameReduction::operator()(std::span<const float> frame, std::span<float> reduced) {
    assert(frame.size() == source_.sites() && reduced.size() == resized_.sites());
    if (!crop_.empty()) {
        auto to = crop_.begin();
        for (int plane = 0; plane < source_.planes; ++plane)
            for (int row = 0; row < cropped_.rows; ++row) {
                const std::size_t first = index(plane) * source_.pixels() +
                                          row_major(corner_.row + row, corner_.col, source_.cols);
                to = std::ranges::copy(frame.subspan(first, index(cropped_.cols)), to).out;
            }
        frame = crop_;
    }
    if (!bin_.empty()) {
        average_planes(frame, cropped_, bin_, binned_);
        frame = bin_;
    }
    if (resized_ != binned_)
        average_planes(frame, binned_, reduced, resized_);
    else
        std::ranges::copy(frame, reduced.begin());
}

}  // namespace stipple
