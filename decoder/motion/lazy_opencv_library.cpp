// What libstipple_opencv.so holds: decoder/motion/lazy_opencv.h.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <opencv2/optflow.hpp>
#include <opencv2/video/tracking.hpp>

#include "decoder/motion/lazy_opencv.h"

namespace {

using stipple::PlaneView;

double mean(PlaneView<const float> image) {
    const std::span light(image.data(), static_cast<std::size_t>(image.rows()) *
                                            static_cast<std::size_t>(image.cols()));
    return std::accumulate(light.begin(), light.end(), 0.0) / static_cast<double>(light.size());
}

/// Levels 0..255 of light of any brightness: the square root of x / (1 + x), x = light / mean.
cv::Mat levels(PlaneView<const float> image, double mean_light) {
    cv::Mat result(image.rows(), image.cols(), CV_8U);
    const auto scale = static_cast<float>(mean_light > 0 ? 1 / mean_light : 1);
    std::transform(image.data(), image.data() + result.total(), result.ptr<std::uint8_t>(),
                   [scale](float light) {
                       const float x = scale * std::max(light, 0.0F);
                       return static_cast<std::uint8_t>(255 * std::sqrt(x / (1 + x)) + 0.5F);
                   });
    return result;
}

}  // namespace

/// OpenCV splits the images between its threads, and the flow depends on where.
extern "C" __attribute__((visibility("default"))) void stipple_dis_flow(PlaneView<const float> from,
                                                                        PlaneView<const float> to,
                                                                        std::span<float> flow) {
    cv::Mat result(from.rows(), from.cols(), CV_32FC2, flow.data());
    const double mean_light = (mean(from) + mean(to)) / 2;
    const int threads = cv::getNumThreads();
    cv::setNumThreads(1);
    cv::DISOpticalFlow::create(cv::DISOpticalFlow::PRESET_MEDIUM)
        ->calc(levels(from, mean_light), levels(to, mean_light), result);
    cv::setNumThreads(threads);
}

extern "C" __attribute__((visibility("default"))) void stipple_tv_l1_flow(
    stipple::PlaneView<float> from, stipple::PlaneView<float> to, std::span<float> flow) {
    const auto image = [](stipple::PlaneView<float> plane) {
        return cv::Mat(plane.rows(), plane.cols(), CV_32F, plane.data());
    };
    cv::Mat result(from.rows(), from.cols(), CV_32FC2, flow.data());
    cv::optflow::DualTVL1OpticalFlow::create()->calc(image(from), image(to), result);
}
