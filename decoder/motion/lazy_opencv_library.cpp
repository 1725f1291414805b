// What libstipple_opencv.so holds: decoder/motion/lazy_opencv.h.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <numeric>
#include <opencv2/core/utils/logger.hpp>
#include <opencv2/dnn.hpp>
#include <opencv2/optflow.hpp>
#include <opencv2/video/tracking.hpp>
#include <stdexcept>
#include <string>
#include <utility>

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

/// Calls `body` with exceptions of OpenCV reduced to the reason.
template <typename Body>
void with_short_reason(const Body& body) try {
    body();
} catch (const cv::Exception& e) {
    throw std::runtime_error(e.err);
}

std::string text_of(const cv::MatSize& size) {
    std::string text;
    for (int i = 0; i < size.dims(); ++i) text += (i == 0 ? "" : " x ") + std::to_string(size[i]);
    return text;
}

}  // namespace

extern "C" __attribute__((visibility("default"))) void stipple_open_network(
    std::span<const std::uint8_t> onnx, stipple::ImageNetwork& network) {
    const auto net = std::make_shared<cv::dnn::Net>();
    with_short_reason([&] {
        *net = cv::dnn::readNetFromONNX(reinterpret_cast<const char*>(onnx.data()), onnx.size());
    });
    network = [net](std::span<const float> channels, PlaneView<float> image) {
        const std::size_t pixels =
            static_cast<std::size_t>(image.rows()) * static_cast<std::size_t>(image.cols());
        const int sizes[] = {1, static_cast<int>(channels.size() / pixels), image.rows(),
                             image.cols()};
        with_short_reason([&] {
            // OpenCV only reads it.
            net->setInput(cv::Mat(4, sizes, CV_32F, const_cast<float*>(channels.data())));
            const cv::Mat result = net->forward();
            if (result.type() != CV_32F || result.dims != 4 || result.total() != pixels ||
                result.size[2] != image.rows())
                CV_Error(cv::Error::StsUnmatchedSizes, "it gives " + text_of(result.size));
            std::copy_n(result.ptr<float>(), pixels, image.data());
        });
    };
}

extern "C" __attribute__((visibility("default"))) void stipple_swap_opencv_settings(
    int& threads, int& log_level) {
    const int before = cv::getNumThreads();
    cv::setNumThreads(std::exchange(threads, before));
    log_level =
        cv::utils::logging::setLogLevel(static_cast<cv::utils::logging::LogLevel>(log_level));
}

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
