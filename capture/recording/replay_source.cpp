#include "capture/recording/replay_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <string_view>
#include <utility>

#include "capture/frame_light.h"
#include "core/error.h"
#include "core/text.h"
#include "stream/little_endian.h"

namespace stipple {
namespace {

/// The format of 16 bits whose pixels lie behind this filter.
std::string_view words_behind(ColourFilter filter) {
    constexpr std::array<std::string_view, 5> kNames{"Mono16", "BayerRG16", "BayerGR16",
                                                     "BayerGB16", "BayerBG16"};
    return kNames[static_cast<std::size_t>(filter)];
}

/// \throws InputError if frames with the mosaic of `filter` do not come in `format`.
void check_mosaic(ColourFilter filter, const PixelFormat& format) {
    if (filter == ColourFilter::kNone || format.filter == ColourFilter::kNone ||
        format.filter == filter)
        return;
    throw InputError("PixelFormat",
                     fmt::format("the footage is a mosaic that begins as {}, not as {}; write {}",
                                 name_of(filter), format.name, words_behind(filter)));
}

/// Of footage of this shape, which may be a mosaic. Its format is `name`, or if that is empty the
/// one of 16 bits, in colour of 8.
FrameLayout footage_layout(FrameShape shape, ColourFilter filter, const std::string& name) {
    const std::string_view of_shape = shape.planes == 3 ? "RGB8" : words_behind(filter);
    const std::string_view wanted = name.empty() ? of_shape : std::string_view(name);
    const PixelFormat* format = pixel_format_named(wanted);
    const bool mosaic = format != nullptr && format->filter != ColourFilter::kNone &&
                        format->packing == Packing::kBytes && format->significant_bits % 8 == 0;
    const bool plain = wanted == "Mono8" || wanted == "Mono16" || wanted == "RGB8";
    const int mosaic_planes = filter == ColourFilter::kNone ? 3 : 1;
    if (format == nullptr || !(plain || mosaic) ||
        (mosaic ? mosaic_planes : format->planes) != shape.planes)
        throw InputError(
            "PixelFormat",
            fmt::format("footage of {} planes does not come in \"{}\"; write {}", shape.planes,
                        wanted,
                        shape.planes == 3 ? "RGB8, or BayerRG8 ... BayerBG16" : "Mono8 or Mono16"));
    check_mosaic(filter, *format);
    return {.format = format,
            .width = shape.cols,
            .height = shape.rows,
            .stride_bytes = format->row_bytes(shape.cols)};
}

}  // namespace

ReplaySource::ReplaySource(const std::filesystem::path& path, const std::string& format)
    : path_(path) {
    if (!stipple::is_recording(path)) {
        open_footage();
        layout_ = footage_layout(footage_->shape(), footage_->filter(), format);
        light_.resize(footage_->shape().sites());
        look_at_first_frame();
        rewind();
        return;
    }
    recording_.emplace(path);
    CapturedFrame first;
    if (!recording_->next(first)) throw InputError(path.string(), "holds no frame");
    layout_ = first.record.layout;
    if (!format.empty() && format != layout_.format->name)
        throw InputError("PixelFormat", fmt::format("the recording is in {}; it is played as it is",
                                                    layout_.format->name));
    recording_->rewind();
}

/// A replay is a camera, whose numbers are linear: what is not gets a warning of its own.
void ReplaySource::open_footage() {
    footage_.emplace(path_, FootageOptions{.transfer = Transfer::kLinear, .max_value = {}});
}

void ReplaySource::look_at_first_frame() {
    const std::string name = path_.string();
    if (footage_->gamma_coded())
        warnings_.push_back(name +
                            ": looks gamma-coded, and is played as linear light; emulation and "
                            "served cameras have " +
                            Parameter{"transfer"});
    const bool has_frame = footage_->read(light_);
    for (Message& warning : footage_->take_warnings()) warnings_.push_back(std::move(warning));
    std::string clipping = has_frame ? clipping_text(name, light_, *layout_.format) : "";
    if (!clipping.empty()) warnings_.push_back(std::move(clipping));
}

Message ReplaySource::end_warning() {
    if (recording_) {
        const auto found = recording_->faults();
        return found.empty() ? "" : fmt::format("{}: {}", path_.string(), joined(found));
    }
    Message found;
    for (const Message& warning : footage_->take_warnings())
        if (std::ranges::find(warnings_, warning) == warnings_.end())
            found += (found.empty() ? Message() : "; ") + warning;
    return found;
}

const SessionRecord* ReplaySource::session() const {
    return recording_ ? &recording_->session() : nullptr;
}

bool ReplaySource::next(CapturedFrame& frame) {
    if (recording_) return recording_->next(frame);
    if (!footage_->read(light_)) return false;
    frame.record = {};
    frame.holes.clear();
    frame.record.id = next_id_++;
    frame.record.layout = layout_;
    quantise(frame.payload);
    frame.record.bytes_received = frame.payload.size();
    return true;
}

void ReplaySource::quantise(std::vector<std::uint8_t>& payload) const {
    const auto planes = static_cast<std::size_t>(layout_.format->planes);
    const auto cols = static_cast<std::size_t>(layout_.width);
    const std::size_t pixels = cols * static_cast<std::size_t>(layout_.height);
    // Footage behind a filter array has one plane.
    const ColourFilter filter =
        footage_->shape().planes == 1 ? ColourFilter::kNone : layout_.format->filter;
    const bool words = layout_.format->significant_bits == 16;
    const float full_scale = words ? 65535.0F : 255.0F;
    payload.resize(layout_.payload_bytes());
    for (std::size_t pixel = 0; pixel < pixels; ++pixel)
        for (std::size_t plane = 0; plane < planes; ++plane) {
            const int seen = filter == ColourFilter::kNone
                                 ? static_cast<int>(plane)
                                 : colour_plane(filter, static_cast<int>(pixel / cols),
                                                static_cast<int>(pixel % cols));
            const float light =
                std::min(light_[static_cast<std::size_t>(seen) * pixels + pixel], 1.0F);
            const auto dn = static_cast<std::uint16_t>(light * full_scale + 0.5F);
            const std::size_t sample = pixel * planes + plane;
            if (words)
                store(&payload[2 * sample], dn);
            else
                payload[sample] = static_cast<std::uint8_t>(dn);
        }
}

void ReplaySource::rewind() {
    next_id_ = 0;
    recording_ ? recording_->rewind() : open_footage();
}

}  // namespace stipple
