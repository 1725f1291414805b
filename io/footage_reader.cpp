#include "io/footage_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "core/error.h"
#include "core/hdr_curves.h"
#include "core/light.h"
#include "core/memory_limit.h"
#include "io/footage_files.h"
#include "io/footage_formats.h"
#include "io/footage_warnings.h"

namespace stipple {
namespace fs = std::filesystem;

struct FootageReader::Impl {
    FrameSource source;
    FootageOptions options;
    std::string name;
    std::string extension;
    FrameShape source_shape;
    SourceInfo traits;
    Transfer transfer = Transfer::kLinear;
    std::vector<Message> warnings;  ///< not yet taken
    bool looked_at_brightness = false;
    bool at_end = false;
    std::vector<float> colour;  ///< the frame before its reduction to luminance
    std::vector<float> whole;   ///< the frame before its reduction to the part
    std::optional<FrameReduction> reduction;
    int position = 0;  ///< frame of the source that comes next

    Impl(const fs::path& path, const FootageOptions& wanted);
    [[nodiscard]] bool reduces() const { return options.luminance && source_shape.planes == 3; }
    /// Of frames that are not reduced to the part yet.
    [[nodiscard]] FrameShape whole_shape() const {
        return {source_shape.rows, source_shape.cols, reduces() ? 1 : source_shape.planes};
    }
    /// Number of frames of the source, if it declares it.
    [[nodiscard]] std::optional<int> source_slots() const;
    void check_frames() const;
    bool read_whole(std::span<float> frame);
    void skip(int frames);
    void make_linear(std::span<float> light) const;
    void warn(Message text) {
        if (!text.empty()) warnings.push_back(std::move(text));
    }
};

FootageReader::Impl::Impl(const fs::path& path, const FootageOptions& wanted)
    : source(open_source(path, wanted)),
      options(wanted),
      name(path.string()),
      extension(lower_extension(path)) {
    source_shape = std::visit([](const auto& s) { return s.shape(); }, source);
    if (reduces()) colour.resize(source_shape.sites());
    std::visit(
        [this](const auto& s) {
            if constexpr (requires { s.traits(); }) traits = s.traits();
        },
        source);
    if (const auto* images = std::get_if<ImageSequence>(&source)) warn(images->warning());
    if (const auto* video = std::get_if<VideoReader>(&source)) {
        traits.frames_hz = video->frames_hz();
        traits.announced_frames = video->announced_frames();
    }
    if (options.frames_hz) traits.frames_hz = options.frames_hz;
    if (options.luminance && traits.filter != ColourFilter::kNone)
        throw InputError(name, "is the mosaic of a colour filter array, of which there is no " +
                                   Parameter{"luminance"});
    if (options.min_value && options.max_value && *options.min_value > *options.max_value)
        throw InputError(name, Parameter{"min_value", fmt::to_string(*options.min_value)} +
                                   " is above " +
                                   Parameter{"max_value", fmt::to_string(*options.max_value)});
    transfer = transfer_of(options, traits, std::holds_alternative<VideoReader>(source), name);
    for (Message& text : reading_warnings(traits, options, name)) warn(std::move(text));
    check_frames();
    if (options.part.has_whole_frames()) return;
    constexpr std::uint64_t kSiteBytes = 12;  // the whole frame and two steps of its reduction
    check_memory(kSiteBytes * whole_shape().sites(), name,
                 fmt::format("frames of {} x {}", source_shape.cols, source_shape.rows),
                 input_bytes(path));
    reduction.emplace(options.part, whole_shape(), traits.filter, name);
}

std::optional<int> FootageReader::Impl::source_slots() const {
    const auto slots_of = [](const auto& frames) -> std::optional<int> {
        if constexpr (requires { frames.slots(); }) return frames.slots();
        return std::nullopt;
    };
    return std::visit(slots_of, source);
}

/// \throws InputError if it is known that the source has not all frames of the part.
void FootageReader::Impl::check_frames() const {
    const FrameRange& frames = options.part.frames;
    const auto slots = source_slots();
    if (slots && std::max(frames.begin + 1, frames.end.value_or(0)) > *slots)
        throw InputError(name, fmt::format("has {} frames, so not all of ", *slots) +
                                   Parameter{"frames", text_of(frames)});
}

/// Light of HDR video has the primaries of BT.709 afterwards, as all other.
void FootageReader::Impl::make_linear(std::span<float> light) const {
    linearise(light, transfer);
    const bool hdr = transfer == Transfer::kPq || transfer == Transfer::kHlg;
    if (hdr && traits.bt2020 && source_shape.planes == 3) bt2020_to_bt709(light);
}

FootageReader::FootageReader(const fs::path& source, const FootageOptions& options)
    : impl_(std::make_unique<Impl>(source, options)) {}

FootageReader::~FootageReader() = default;
FootageReader::FootageReader(FootageReader&&) noexcept = default;
FootageReader& FootageReader::operator=(FootageReader&&) noexcept = default;

FrameShape FootageReader::shape() const {
    return impl_->reduction ? impl_->reduction->shape() : impl_->whole_shape();
}

std::optional<int> FootageReader::slots() const {
    const FrameRange& frames = impl_->options.part.frames;
    const auto slots = frames.end ? frames.end : impl_->source_slots();
    return slots ? std::optional<int>(*slots - frames.begin) : std::nullopt;
}

std::optional<double> FootageReader::frames_hz() const {
    return impl_->traits.frames_hz;
}

std::optional<double> FootageReader::exposure_us() const {
    return impl_->traits.exposure_us;
}

bool FootageReader::has_times() const {
    const auto* const raw = std::get_if<RawVideoReader>(&impl_->source);
    const bool is_video = std::holds_alternative<VideoReader>(impl_->source);
    return !impl_->options.frames_hz && (is_video || (raw != nullptr && raw->has_times()));
}

double FootageReader::frame_time() const {
    const auto* const video = std::get_if<VideoReader>(&impl_->source);
    return video != nullptr ? video->frame_time()
                            : std::get<RawVideoReader>(impl_->source).frame_time();
}

ColourFilter FootageReader::filter() const {
    return impl_->traits.filter;
}

const SourceInfo& FootageReader::traits() const {
    return impl_->traits;
}

std::string FootageReader::kind() const {
    if (const auto* images = std::get_if<ImageSequence>(&impl_->source)) return images->kind();
    if (std::holds_alternative<VideoReader>(impl_->source)) return "video";
    return impl_->options.raw ? "frames without a header" : impl_->extension + " file";
}

bool FootageReader::gamma_coded() const {
    return impl_->traits.gamma_coded;
}

std::vector<Message> FootageReader::take_warnings() {
    return std::exchange(impl_->warnings, {});
}

bool FootageReader::Impl::read_whole(std::span<float> frame) {
    const auto light = reduces() ? std::span<float>(colour) : frame;
    const auto read = [&](auto& frames) {
        if (!frames.read(light)) return false;
        make_linear(light);
        check_light(light, source_shape, frames.where(),
                    options.negative || options.min_value.has_value());
        if (options.scale != 1) scale_light(light, options.scale, frames.where());
        if (!std::exchange(looked_at_brightness, true) && !options.max_value && options.scale == 1)
            warn(brightness_warning(light, frames.where()));
        return true;
    };
    if (!std::visit(read, source)) {
        if (std::exchange(at_end, true)) return false;
        if (const auto* images = std::get_if<ImageSequence>(&source))
            if (const std::string text = images->exposure_warning(); !text.empty())
                warn(fmt::format("{}: {}", name, text));
        if (const auto* video = std::get_if<VideoReader>(&source)) {
            for (Message& text : video->warnings()) warn(std::move(text));
            warn(unequal_times_warning(video->unequal_times(), options, name));
        }
        return false;
    }
    ++position;
    if (reduces()) reduce_to_luminance(light, frame);
    return true;
}

void FootageReader::Impl::skip(int frames) {
    std::vector<float> light;
    const auto skip_frames = [&](auto& reader) {
        if constexpr (requires { reader.skip(frames); }) return reader.skip(frames);
        light.resize(reader.shape().sites());
        for (int i = 0; i < frames && reader.read(light); ++i) {
        }
    };
    std::visit(skip_frames, source);
    position += frames;
}

bool FootageReader::read(std::span<float> frame) {
    assert(frame.size() == shape().sites());
    Impl& impl = *impl_;
    const FrameRange& frames = impl.options.part.frames;
    if (impl.position < frames.begin) impl.skip(frames.begin - impl.position);
    if (frames.end && impl.position >= *frames.end) return false;
    std::span<float> whole = frame;
    if (impl.reduction) {
        impl.whole.resize(impl.whole_shape().sites());
        whole = impl.whole;
    }
    if (!impl.read_whole(whole)) {
        if (impl.position == frames.begin && frames.begin > 0)
            throw InputError(impl.name, "ends before " + Parameter{"frames", text_of(frames)});
        if (frames.end)
            throw InputError(impl.name,
                             "ends before the end of " + Parameter{"frames", text_of(frames)});
        return false;
    }
    if (impl.reduction) (*impl.reduction)(whole, frame);
    if (impl.options.min_value) {
        const auto min_light = static_cast<float>(*impl.options.min_value);
        for (float& value : frame) value = std::max(value, min_light);
    }
    if (impl.options.max_value) {
        const auto max_light = static_cast<float>(*impl.options.max_value);
        for (float& value : frame) value = std::min(value, max_light);
    }
    return true;
}

void FootageReader::skip(int frames) {
    const int begin = impl_->options.part.frames.begin;
    impl_->skip(frames + std::max(begin - impl_->position, 0));
}

}  // namespace stipple
