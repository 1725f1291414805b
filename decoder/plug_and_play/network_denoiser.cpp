#include "decoder/plug_and_play/network_denoiser.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <utility>

#include "core/error.h"
#include "core/index.h"
#include "core/parallel.h"
#include "decoder/motion/lazy_opencv.h"

namespace stipple {
namespace {

constexpr int kMultiple = 8;  // of the sides, so that three levels of a U-Net have whole sides

int padded(int side) {
    return (side + kMultiple - 1) / kMultiple * kMultiple;
}

class NetworkDenoiser {
  public:
    NetworkDenoiser(std::string name, std::vector<std::uint8_t> onnx, int frames)
        : name_(std::move(name)), onnx_(std::move(onnx)), frames_(frames) {
        const QuietOpenCv quiet;
        give_back(take());
    }

    void denoise(const DenoiserInput& input, FluxVideo& result) {
        const QuietOpenCv quiet;  // and serial: bits may depend on where layers are split
        const int planes = result.shape().planes;
        parallel_for(0, result.slots() * planes, [&](int i) {
            ImageNetwork network = take();
            denoise_plane(network, input, {i / planes, i % planes}, result);
            give_back(std::move(network));
        });
    }

  private:
    struct Place {
        int slot;
        int plane;
    };

    /// Of a thread, as OpenCV's are for one at a time.
    ImageNetwork take() {
        {
            const std::scoped_lock lock(mutex_);
            if (!free_.empty()) {
                ImageNetwork network = std::move(free_.back());
                free_.pop_back();
                return network;
            }
        }
        try {
            return open_network(onnx_);
        } catch (const std::runtime_error& e) {
            throw InputError(
                name_, fmt::format("is not a network in ONNX that OpenCV reads: {}", e.what()));
        }
    }
    void give_back(ImageNetwork network) {
        const std::scoped_lock lock(mutex_);
        free_.push_back(std::move(network));
    }

    void denoise_plane(const ImageNetwork& network, const DenoiserInput& input, Place place,
                       FluxVideo& result) const {
        const FrameShape shape = result.shape();
        const int rows = padded(shape.rows), cols = padded(shape.cols);
        std::vector<float> channels;
        channels.reserve(index(frames_ + 1) * index(rows) * index(cols));
        for (int k = -frames_ / 2; k <= frames_ / 2; ++k) {
            const int slot = std::clamp(place.slot + k, 0, result.slots() - 1);
            const PlaneView<const float> frame = input.noisy.plane(slot, place.plane);
            for (int row = 0; row < rows; ++row)
                for (int col = 0; col < cols; ++col)
                    channels.push_back(
                        frame(std::min(row, shape.rows - 1), std::min(col, shape.cols - 1)));
        }
        channels.resize(channels.capacity(), input.sigma);
        std::vector<float> image(index(rows) * index(cols));
        try {
            network(channels, {image.data(), rows, cols});
        } catch (const std::runtime_error& e) {
            throw InputError(
                name_,
                fmt::format("as a denoiser takes 1 x {} x {} x {} ({} frame{} and the noise map, "
                            "rows, columns) and gives 1 x 1 x {} x {}, but this network does not: "
                            "{}; the number of frames is ",
                            frames_ + 1, rows, cols, frames_, frames_ == 1 ? "" : "s", rows, cols,
                            e.what()) +
                    Parameter{"decoder.denoiser_frames"});
        }
        const PlaneView<float> to = result.plane(place.slot, place.plane);
        for (int row = 0; row < shape.rows; ++row)
            std::copy_n(&image[index(row) * index(cols)], shape.cols, &to(row, 0));
    }

    std::string name_;
    std::vector<std::uint8_t> onnx_;
    int frames_;
    std::mutex mutex_;
    std::vector<ImageNetwork> free_;
};

}  // namespace

DenoiserMaker network_denoiser(const std::string& name, std::vector<std::uint8_t> onnx,
                               int frames) {
    auto network = std::make_shared<NetworkDenoiser>(name, std::move(onnx), frames);
    return [network](const CollaborativeOptions&, bool) -> Denoiser {
        return [network](const DenoiserInput& input, FluxVideo& result) {
            network->denoise(input, result);
        };
    };
}

}  // namespace stipple
