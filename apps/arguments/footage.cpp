#include "apps/arguments/footage.h"

#include <string>

#include "apps/arguments/common_options.h"
#include "apps/standard_streams.h"
#include "core/error.h"
#include "study/scenes/scene.h"

namespace stipple {

void add_footage_arguments(Command& command, FootageOptions& options, const std::string& footage) {
    command
        .add_choice("--transfer", options.transfer, kTransfers,
                    "transfer function of " + footage + "; auto: the declared one")
        .default_text("linear, with a warning if they look gamma-coded")
        .type_name("NAME");
    add_raw_argument(command, options.raw, footage);
    command.add_flag("--luminance", options.luminance,
                     "reduce colour footage to Rec. 709 luminance");
    command
        .add_option("--min-value", options.min_value, "clip light of " + footage + " below V to V")
        .default_text("negative light is refused")
        .check(number_check(0, 1e9))
        .type_name("V");
}

void add_raw_argument(Command& command, std::optional<RawFormat>& raw, const std::string& footage) {
    const auto take_raw = [&raw](const std::string& text) {
        try {
            raw = parse_raw_format(text);
        } catch (const InputError& e) {
            throw UsageError("--raw", e.what());
        }
    };
    command
        .add_parsed("--raw", take_raw,
                    "read " + footage + " as frames without a header, such as 640x480:mono12p")
        .type_name("SIZE:FORMAT[:KEY=VALUE]...");
}

void add_max_value(Command& command, std::optional<double>& max_value) {
    command.add_option("--max-value", max_value, "first clip light to V")
        .default_text("not clipped")
        .check(positive_check())
        .type_name("V");
}

void add_resample_arguments(Command& command, std::optional<Resampling>& method,
                            FootageOptions& options) {
    command
        .add_choice("--resample", method, kResamplings,
                    "convert footage of another frame rate to slots: hold the frame before, blend "
                    "light, or move it by optical flow")
        .default_text("each frame is a slot")
        .type_name("METHOD");
    command.add_option("--frames-hz", options.frames_hz, "frame rate of the footage")
        .default_text("that in its file")
        .check(number_check(kMinFramesHz, kMaxFramesHz))
        .type_name("HZ");
}

void add_part_arguments(Command& command, FootageOptions& options) {
    FootagePart& part = options.part;
    const auto parsed = [](const char* option, auto& target, auto parse) {
        return [option, &target, parse](const std::string& text) {
            try {
                target = parse(text);
            } catch (const InputError& e) {
                throw UsageError(option, e.what());
            }
        };
    };
    command
        .add_parsed("--frames", parsed("--frames", part.frames, parse_frame_range),
                    "frames A to B - 1 of the footage; A or B may be left out")
        .default_text("all")
        .type_name("A:B");
    command
        .add_parsed("--crop", parsed("--crop", part.crop, parse_crop_area),
                    "area of the frames: width, height, first column, first row; WxH is the middle")
        .default_text("all")
        .type_name("WxH+X+Y");
    command.add_option("--bin", part.bin, "then take the mean light of N x N pixels")
        .shows_default()
        .check(whole_check(1, FootagePart::kMaxBin))
        .type_name("N");
    command
        .add_parsed(
            "--resize",
            [&part](const std::string& text) {
                parse_size("--resize", text, {1, kMaxFrameSide}, part.size.emplace());
            },
            "then reduce to this width and height, by the mean light of areas")
        .default_text("as they are")
        .type_name("WxH");
    command.add_option("--scale", options.scale, "multiply light by this: the exposure")
        .shows_default()
        .check(positive_check())
        .type_name("FACTOR");
}

ReadAhead read_footage(const std::string& source, const FootageOptions& options) {
    return ReadAhead(source, options, [](const Message& warning) { say_warning(warning); });
}

void add_scene_arguments(Command& command, SceneOptions& options) {
    constexpr SideRange kSides{SceneOptions::kMinSide, SceneOptions::kMaxSide};
    command.add_option("--frames", options.slots, "number of frames, of 1/200 s each")
        .shows_default()
        .check(whole_check(1, SceneOptions::kMaxSlots))
        .type_name("N");
    add_size(command, "--size", options.shape, kSides, "width and height of the scene");
    add_seed(command, options.seed, "seed of textures and arrangement");
}

}  // namespace stipple
