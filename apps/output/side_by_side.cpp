#include "apps/output/side_by_side.h"

#include <algorithm>
#include <opencv2/imgproc.hpp>

#include "core/plane.h"
#include "io/image_file.h"
#include "io/pending_output.h"
#include "io/tone_map.h"

namespace stipple {
namespace {

constexpr int kNameRows = 20;
constexpr int kGapCols = 4;

/// `name` in white on black. OpenCV smooths letters in 8 bits only.
cv::Mat name_strip(const std::string& name, int cols) {
    cv::Mat strip(kNameRows, cols, CV_8UC1, cv::Scalar(0));
    cv::putText(strip, name, {2, kNameRows - 6}, cv::FONT_HERSHEY_SIMPLEX, 0.42, cv::Scalar(255), 1,
                cv::LINE_AA);
    return strip;
}

}  // namespace

SideBySide::SideBySide(FrameShape shape, const std::vector<std::string>& names)
    : frame_(shape), canvas_(shape) {
    const auto versions = static_cast<int>(names.size());
    canvas_.rows += kNameRows;
    canvas_.cols = versions * (shape.cols + kGapCols) - kGapCols;
    light_.resize(canvas_.sites());
    for (std::size_t version = 0; version < names.size(); ++version) {
        const cv::Mat strip = name_strip(names[version], shape.cols);
        for (int plane = 0; plane < shape.planes; ++plane)
            for (int row = 0; row < kNameRows; ++row)
                std::transform(strip.ptr(row), strip.ptr(row) + shape.cols,
                               canvas_row(plane, row, version).begin(), [](std::uint8_t grey) {
                                   return static_cast<float>(grey) / 255 * kWhiteLight;
                               });
    }
}

std::span<float> SideBySide::canvas_row(int plane, int row, std::size_t version) {
    const PlaneView<float> view(light_.data() + static_cast<std::size_t>(plane) * canvas_.pixels(),
                                canvas_.rows, canvas_.cols);
    const auto width = static_cast<std::size_t>(frame_.cols);
    return view.row(row).subspan(version * (width + kGapCols), width);
}

void SideBySide::put(std::size_t version, std::span<const float> frame) {
    auto from = frame.begin();
    for (int plane = 0; plane < frame_.planes; ++plane)
        for (int row = 0; row < frame_.rows; ++row, from += frame_.cols)
            std::copy_n(from, frame_.cols, canvas_row(plane, kNameRows + row, version).begin());
}

void SideBySide::write(const std::filesystem::path& file, bool force) const {
    PendingOutput output(file, force);
    write_png(output.partial(), output.final_path().string(), canvas_, light_);
    output.commit();
}

}  // namespace stipple
