#include "core/video_writer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <opencv2/imgproc.hpp>
#include <string>

#include "core/error.h"
#include "core/late_opencv.h"
#include "core/opencv_quiet.h"
#include "core/tone_map.h"
#include "core/video_decoder.h"

namespace stipple {

struct VideoWriter::Impl {
    std::string file;
    std::string place;
    FrameShape shape;
    FilmFrames film;
    cv::Mat pixels;  ///< as tone-mapped
    cv::Mat colour;  ///< as encoded: BGR
    int frames = 0;

    /// Even, and at least four columns: FFmpeg 5.1 converts narrower frames beyond their memory.
    [[nodiscard]] cv::Size encoded_size() const {
        return {std::max(shape.cols + shape.cols % 2, 4), shape.rows + shape.rows % 2};
    }
    /// Frames that can be decoded from the file.
    [[nodiscard]] int readable_frames() const {
        int count = 0;
        try {
            for (VideoDecoder written(file); written.next() != nullptr;) ++count;
        } catch (const InputError&) {
            // The file is cut: those that were read count.
        }
        return count;
    }
};

VideoWriter::VideoWriter(const std::filesystem::path& file, std::string_view place,
                         FrameShape shape, double frames_per_second)
    : impl_(std::make_unique<Impl>()) {
    silence_opencv();
    impl_->file = file.string();
    impl_->place = place;
    impl_->shape = shape;
    impl_->pixels.create(shape.rows, shape.cols, shape.planes == 1 ? CV_8UC1 : CV_8UC3);
    try {
        const cv::Size size = impl_->encoded_size();
        impl_->film = late_opencv().create_film(
            impl_->file,
            {.rows = size.height, .cols = size.width, .frames_per_second = frames_per_second});
        if (impl_->film) return;
    } catch (const cv::Exception&) {
        // Reported below: OpenCV's own text names no cause that a user could act on.
    }
    throw DeviceError(place, fmt::format("no video of {} x {} pixels at {} frames per second can "
                                         "be created here",
                                         shape.cols, shape.rows, frames_per_second));
}

VideoWriter::~VideoWriter() = default;
VideoWriter::VideoWriter(VideoWriter&&) noexcept = default;
VideoWriter& VideoWriter::operator=(VideoWriter&&) noexcept = default;

void VideoWriter::write(std::span<const float> frame) {
    const FrameShape shape = impl_->shape;
    tone_map_frame(frame, shape, {impl_->pixels.data, shape.sites()});
    try {
        cv::Mat colour;
        cv::cvtColor(impl_->pixels, colour,
                     shape.planes == 1 ? cv::COLOR_GRAY2BGR : cv::COLOR_RGB2BGR);
        const cv::Size size = impl_->encoded_size();
        cv::copyMakeBorder(colour, impl_->colour, 0, size.height - shape.rows, 0,
                           size.width - shape.cols, cv::BORDER_REPLICATE);
        impl_->film({impl_->colour.data, impl_->colour.total() * impl_->colour.elemSize()});
    } catch (const cv::Exception& e) {
        throw DeviceError(impl_->place, fmt::format("cannot be written: {}", e.err));
    }
    ++impl_->frames;
}

void VideoWriter::finish() {
    impl_->film = {};
    const int readable = impl_->readable_frames();
    if (readable != impl_->frames)
        throw DeviceError(impl_->place,
                          fmt::format("only {} of {} frames could be written; is the disk full?",
                                      readable, impl_->frames));
}

}  // namespace stipple
