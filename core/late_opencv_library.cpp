// What libstipple_opencv.so holds: core/late_opencv.h.
#include <memory>
#include <opencv2/optflow.hpp>
#include <opencv2/videoio.hpp>

#include "core/late_opencv.h"

namespace stipple {
namespace {

FilmFrames create_film(const std::string& file, const FilmFormat& format) {
    const cv::Size size(format.cols, format.rows);
    const auto film = std::make_shared<cv::VideoWriter>();
    const int h264 = cv::VideoWriter::fourcc('a', 'v', 'c', '1');
    const int mpeg4 = cv::VideoWriter::fourcc('m', 'p', '4', 'v');
    for (const int codec : {h264, mpeg4})
        if (film->open(file, cv::CAP_FFMPEG, codec, format.frames_per_second, size))
            return [film, size](std::span<std::uint8_t> frame) {
                film->write(cv::Mat(size, CV_8UC3, frame.data()));
            };
    return {};
}

void tv_l1_flow(PlaneView<float> from, PlaneView<float> to, std::span<float> flow) {
    const auto image = [](PlaneView<float> plane) {
        return cv::Mat(plane.rows(), plane.cols(), CV_32F, plane.data());
    };
    cv::Mat result(from.rows(), from.cols(), CV_32FC2, flow.data());
    cv::optflow::DualTVL1OpticalFlow::create()->calc(image(from), image(to), result);
}

}  // namespace
}  // namespace stipple

extern "C" __attribute__((visibility("default")))
const stipple::LateOpenCv stipple_late_opencv{stipple::create_film, stipple::tv_l1_flow};
