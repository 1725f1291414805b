// What libstipple_opencv.so holds: core/late_opencv.h.
#include <memory>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/optflow.hpp>
#include <opencv2/videoio.hpp>

#include "core/late_opencv.h"

namespace stipple {
namespace {

PngPixels decode_png(std::span<const std::uint8_t> file, PngLayout layout) {
    const cv::Mat bytes(1, static_cast<int>(file.size()), CV_8U,
                        const_cast<std::uint8_t*>(file.data()));  // which imdecode only reads
    const int flags = layout == PngLayout::kAsStored ? cv::IMREAD_UNCHANGED
                      : layout == PngLayout::kGrey   ? cv::IMREAD_GRAYSCALE | cv::IMREAD_ANYDEPTH
                                                     : cv::IMREAD_COLOR | cv::IMREAD_ANYDEPTH;
    cv::Mat image = cv::imdecode(bytes, flags);
    if (!image.isContinuous()) image = image.clone();
    return {image.rows,
            image.cols,
            image.channels(),
            static_cast<int>(image.elemSize1()),
            {image.data, image.data + image.total() * image.elemSize()}};
}

// OpenCV's own compression is the fastest, and on noise no larger than others.
std::vector<std::uint8_t> encode_png(PngPixels& pixels) {
    const int depth = pixels.bytes_a_sample == 2 ? CV_16U : CV_8U;
    const cv::Mat image(pixels.rows, pixels.cols, CV_MAKETYPE(depth, pixels.channels),
                        pixels.bytes.data());
    std::vector<std::uint8_t> file;
    cv::imencode(".png", image, file);
    return file;
}

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

extern "C" __attribute__((visibility("default"))) const stipple::LateOpenCv stipple_late_opencv{
    stipple::decode_png, stipple::encode_png, stipple::create_film, stipple::tv_l1_flow};
