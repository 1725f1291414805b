#include "capture/serve/footage_frames.h"

#include <algorithm>
#include <string>
#include <string_view>
#include <utility>

#include "core/error.h"
#include "stream/bit_packing.h"

namespace stipple {
namespace {

/// The formats that footage of this shape can be given in.
std::vector<const PixelFormat*> formats_for(FrameShape shape) {
    std::vector<const PixelFormat*> formats;
    const auto offer = [&](std::string_view name) {
        const PixelFormat* format = pixel_format_named(name);
        if (format == nullptr || shape.cols * format->bits_per_pixel % 8 != 0) return;
        formats.push_back(format);
    };
    if (shape.planes == 1)
        for (const auto* name : {"Mono8", "Mono10", "Mono10p", "Mono12", "Mono12p", "Mono16"})
            offer(name);
    if (shape.planes == 3) offer("RGB8");
    return formats;
}

}  // namespace

FootageFrames::FootageFrames(std::filesystem::path footage, const FootageOptions& options,
                             double frames_per_s, const PixelFormat* preferred)
    : footage_(std::move(footage)), options_(options), reader_(footage_, options_) {
    shape_ = reader_.shape();
    image_.width = shape_.cols;
    image_.height = shape_.rows;
    image_.formats = formats_for(shape_);
    image_.frames_per_s = frames_per_s;
    if (const auto slots = reader_.slots()) image_.frames = static_cast<std::uint64_t>(*slots);
    if (image_.formats.empty())
        throw InputError(footage_.string(), "has neither 1 nor 3 planes; add --luminance");
    if (preferred != nullptr) make_default(*preferred);
    light_.resize(shape_.sites());
    dn_.resize(shape_.sites());
}

void FootageFrames::make_default(const PixelFormat& format) {
    const auto found = std::find(image_.formats.begin(), image_.formats.end(), &format);
    if (found != image_.formats.end()) {
        std::rotate(image_.formats.begin(), found, found + 1);
        return;
    }
    std::string problem = "cannot be served as ";
    problem.append(format.name).append("; this footage can as");
    for (const PixelFormat* other : image_.formats) problem.append(" ").append(other->name);
    throw InputError(footage_.string(), problem);
}

void FootageFrames::start(const PixelFormat& format) {
    reader_ = FootageReader(footage_, options_);
    if (reader_.shape() != shape_)
        throw InputError(footage_.string(), "has changed its size while it was served");
    format_ = &format;
    number_ = 0;
}

std::optional<ServedFrame> FootageFrames::next() {
    if (!reader_.read(light_)) return {};
    quantise_light(light_, shape_, format_->significant_bits, dn_);
    ServedFrame frame;
    frame.number = number_++;
    const int sample_bits = format_->bits_per_pixel / format_->planes;
    frame.payload.resize(packed_bytes(dn_.size(), sample_bits));
    pack_bits(dn_, sample_bits, frame.payload);
    return frame;
}

void quantise_light(std::span<const float> light, FrameShape shape, int bits,
                    std::span<std::uint16_t> dn) {
    const auto planes = static_cast<std::size_t>(shape.planes);
    const float full_scale = static_cast<float>((1 << bits) - 1);
    for (std::size_t plane = 0; plane < planes; ++plane)
        for (std::size_t pixel = 0; pixel < shape.pixels(); ++pixel) {
            const float value = light[plane * shape.pixels() + pixel] * full_scale + 0.5F;
            dn[pixel * planes + plane] =
                static_cast<std::uint16_t>(std::clamp(value, 0.0F, full_scale));
        }
}

}  // namespace stipple
