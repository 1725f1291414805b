#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace stipple::emva1288 {

/// Images of one exposure: two for temporal noise, more for spatial noise.
struct ImageGroup {
    double exposure_ns = 0;
    double photons = 0;  ///< mean number per pixel; 0 for dark images
    bool dark = false;
    std::vector<std::string> files;  ///< names in the descriptor, relative to it
};

/// A measurement by EMVA 1288: the content of a descriptor file of the reference software.
struct Series {
    int bits = 0;
    int cols = 0;
    int rows = 0;
    std::vector<ImageGroup> groups;
};

/// Reads a descriptor: `n bits width height`, and groups that begin with `b exposure_ns photons` or
/// `d exposure_ns` and list their images, `i file`. A version, as `v 4.0`, may be given; 3.x
/// and 4.x mean the same. Empty lines and lines that begin with # are ignored; backslashes in file
/// names are read as slashes, commas in numbers as points.
/// \throws InputError naming `where` and line for all other text, for numbers outside their limits
/// and for a group without two images.
[[nodiscard]] Series parse_series(std::string_view text, std::string_view where);

/// The descriptor of a series.
[[nodiscard]] std::string series_text(const Series& series);

}  // namespace stipple::emva1288
