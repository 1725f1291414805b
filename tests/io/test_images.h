#pragma once

#include <filesystem>
#include <opencv2/imgcodecs.hpp>
#include <vector>

#include "io/footage_reader.h"

namespace stipple {

/// A PNG or TIFF image of one colour. `colour`: grey, or blue, green, red (, alpha).
inline void write_flat(const std::filesystem::path& file, int rows, int cols, int cv_type,
                       cv::Scalar colour) {
    cv::imwrite(file.string(), cv::Mat(rows, cols, cv_type, colour));
}

/// All frames, one after the other.
inline std::vector<float> read_all(const std::filesystem::path& source,
                                   FootageOptions options = {}) {
    FootageReader reader(source, options);
    std::vector<float> all;
    std::vector<float> frame(reader.shape().sites());
    while (reader.read(frame)) all.insert(all.end(), frame.begin(), frame.end());
    return all;
}

}  // namespace stipple
