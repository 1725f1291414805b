#include "capture/serve/served_frames.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>

#include "capture/frame_light.h"
#include "core/error.h"
#include "sensor_model/slot_light.h"
#include "stream/bit_packing.h"

namespace stipple {
namespace {

/// The formats that footage of this shape can be given in; those of a colour filter array only if
/// it is taken for what lies behind one.
std::vector<const PixelFormat*> formats_for(FrameShape shape, ColourFilter filter) {
    std::vector<const PixelFormat*> formats;
    for (const PixelFormat& format : pixel_formats()) {
        const bool has_planes = filter == ColourFilter::kNone
                                    ? format.planes == shape.planes
                                    : shape.planes == 1 || shape.planes == 3;
        const bool can_pack =
            format.packing == Packing::kLsbPacked || format.packing == Packing::kBytes;
        if (format.filter == filter && has_planes && can_pack && format.pfnc != 0 &&
            shape.cols * format.bits_per_pixel % 8 == 0)
            formats.push_back(&format);
    }
    return formats;
}

}  // namespace

FootageFrames::FootageFrames(std::filesystem::path footage, const FootageOptions& options,
                             double frames_hz, const PixelFormat* preferred)
    : footage_(std::move(footage)), options_(options), reader_(footage_, options_) {
    shape_ = reader_.shape();
    image_.width = shape_.cols;
    image_.height = shape_.rows;
    const bool whole_cells = shape_.rows % 2 == 0 && shape_.cols % 2 == 0;
    if (preferred != nullptr)
        filter_ = preferred->filter;
    else if (whole_cells)
        filter_ = reader_.filter();
    check_mosaic();
    check_cells();
    image_.formats = formats_for(shape_, filter_);
    image_.frames_hz = frames_hz;
    if (const auto slots = reader_.slots()) image_.frames = static_cast<std::uint64_t>(*slots);
    if (image_.formats.empty())
        throw InputError(footage_.string(),
                         "has neither 1 nor 3 planes; add " + Parameter{"luminance", "true"});
    if (preferred != nullptr) make_default(*preferred);
    light_.resize(shape_.sites());
    if (reader_.read(light_))  // `start` begins anew
        warn(clipping_text(footage_.string(), light_, *image_.formats.front()));
    const bool takes_mosaic = filter_ != ColourFilter::kNone && shape_.planes == 3;
    if (takes_mosaic) mosaic_.resize(shape_.pixels());
    dn_.resize(takes_mosaic ? shape_.pixels() : shape_.sites());
}

/// Footage that is a mosaic already can be served as that, or as grey.
void FootageFrames::check_mosaic() const {
    const ColourFilter own = reader_.filter();
    if (own == ColourFilter::kNone || filter_ == ColourFilter::kNone || filter_ == own) return;
    throw InputError(footage_.string(),
                     fmt::format("is a mosaic that begins as {}, and cannot be served as {}",
                                 name_of(own), name_of(filter_)));
}

void FootageFrames::check_cells() const {
    if (filter_ == ColourFilter::kNone || (shape_.rows % 2 == 0 && shape_.cols % 2 == 0)) return;
    throw InputError(footage_.string(),
                     fmt::format("has {} x {} pixels; a colour filter array has cells of 2 x 2, so "
                                 "both must be even",
                                 shape_.cols, shape_.rows));
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
    if (mosaic_.empty()) {
        quantise_light(light_, shape_, format_->significant_bits, dn_);
    } else {
        take_mosaic(filter_, shape_, light_, mosaic_);
        quantise_light(mosaic_, {shape_.rows, shape_.cols, 1}, format_->significant_bits, dn_);
    }
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
