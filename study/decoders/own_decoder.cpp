#include "study/decoders/own_decoder.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <string_view>

#include "core/error.h"
#include "decoder/decode_method.h"

namespace stipple {
namespace {

std::string size_text(int slots, FrameShape shape) {
    return fmt::format("{} frame{} of {} x {} pixels and {} plane{}", slots, slots == 1 ? "" : "s",
                       shape.cols, shape.rows, shape.planes, shape.planes == 1 ? "" : "s");
}

}  // namespace

void check_decoder(const OwnDecoder& decoder) {
    constexpr std::size_t kMaxName = 64;
    const std::string where = fmt::format("decoder \"{}\"", decoder.name);
    const auto is_control = [](unsigned char c) { return c < ' ' || c == 127; };
    if (decoder.name.empty() || decoder.name.size() > kMaxName ||
        std::ranges::any_of(decoder.name, is_control))
        throw InputError(where, fmt::format("its name is not a text of 1 to {} bytes without "
                                            "control characters; give it another one",
                                            kMaxName));
    if (std::ranges::find(decode_methods(), std::string_view(decoder.name),
                          &NamedDecodeMethod::name) != decode_methods().end())
        throw InputError(where, "has the name of a method of Stipple; give it another one");
    if (!decoder.decode) throw InputError(where, "has no function");
}

void check_video(const OwnDecoder& decoder, const FluxVideo& video, int slots, FrameShape shape) {
    if (video.slots() != slots || video.shape() != shape)
        throw DecoderFault(fmt::format("decoder \"{}\": gave {}, not {}", decoder.name,
                                       size_text(video.slots(), video.shape()),
                                       size_text(slots, shape)));
    for (int slot = 0; slot < slots; ++slot) {
        const std::span<const float> frame = video.frame(slot);
        const auto found =
            std::ranges::find_if(frame, [](float light) { return !std::isfinite(light); });
        if (found == frame.end()) continue;
        const auto pixel = static_cast<std::size_t>(found - frame.begin()) % shape.pixels();
        const auto cols = static_cast<std::size_t>(shape.cols);
        throw DecoderFault(
            fmt::format("decoder \"{}\": its frame {} has light {} at row {}, col {}", decoder.name,
                        slot, *found, pixel / cols, pixel % cols));
    }
}

}  // namespace stipple
