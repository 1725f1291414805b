#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "study/metrics/emva1288/camera_figures.h"

namespace stipple::emva1288 {

/// DN by row and column.
struct SeriesImage {
    int rows = 0;
    int cols = 0;
    std::vector<std::uint16_t> dn;
};

/// Reads an image.
using ReadImage = std::function<SeriesImage(const std::filesystem::path& file)>;

/// \throws InputError at `where` if an image has another size than the series, or a DN beyond its
/// bits.
void require_image_of(const Series& series, const SeriesImage& image, const std::string& where);

/// Evaluates a series whose images lie in `folder`; `read` is called for each, in their order.
/// \throws InputError naming an image of another size or with a DN beyond the bits of the series,
/// and as evaluate of their statistics, which calls the series `where`.
[[nodiscard]] Evaluation evaluate(const Series& series, const std::filesystem::path& folder,
                                  const ReadImage& read, const std::string& where);

}  // namespace stipple::emva1288
