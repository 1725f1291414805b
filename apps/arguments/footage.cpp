#include "apps/arguments/footage.h"

#include <string>

#include "apps/arguments/checks.h"
#include "apps/report/session_report.h"
#include "core/error.h"
#include "scenes/scene.h"

namespace stipple {

void add_footage_arguments(Command& command, FootageOptions& options, const std::string& footage) {
    command
        .add_choice<std::optional<Transfer>>(
            "--transfer", options.transfer,
            {{"linear", Transfer::kLinear},
             {"gamma22", Transfer::kGamma22},
             {"srgb", Transfer::kSrgb},
             {"bt709", Transfer::kBt709},
             {"pq", Transfer::kPq},
             {"hlg", Transfer::kHlg},
             {"auto", Transfer::kAuto}},
            "how the numbers of " + footage + " map to light; auto: as it declares (linear)")
        .type_name("NAME");
    const auto take_raw = [&options](const std::string& text) {
        try {
            options.raw = parse_raw_format(text);
        } catch (const InputError& e) {
            throw UsageError("--raw", e.what());
        }
    };
    command
        .add_parsed("--raw", take_raw,
                    "read " + footage + " as frames without a header, such as 640x480:mono12p")
        .type_name("SIZE:FORMAT[:KEY=VALUE]...");
    command.add_flag("--luminance", options.luminance, "Rec. 709 luminance of colour footage");
}

void add_max_value(Command& command, std::optional<double>& max_value) {
    command.add_option("--max-value", max_value, "clip light to V first")
        .check(positive_check())
        .type_name("V");
}

void check_recording_options(const std::string& recording, const FootageOptions& options) {
    if (options.transfer.value_or(Transfer::kLinear) != Transfer::kLinear || options.luminance ||
        options.max_value || options.raw)
        throw InputError(recording,
                         "is a recording of a camera, whose numbers are linear: --transfer, --raw, "
                         "--luminance and --max-value are for other footage");
}

ReadAhead read_footage(const std::string& source, const FootageOptions& options) {
    if (is_recording(source)) check_recording_options(source, options);
    return ReadAhead(source, options, say_warning);
}

void add_scene_arguments(Command& command, SceneOptions& options) {
    constexpr int kMinSide = 8;  // as SceneOptions
    constexpr int kMaxSide = 4096;
    constexpr int kMaxSlots = 1000000;
    command.add_option("--frames", options.slots, "frames of 1/200 s (48)")
        .check(whole_check(1, kMaxSlots))
        .type_name("N");
    command
        .add_parsed(
            "--size",
            [&options](const std::string& text) {
                parse_size("--size", text, kMinSide, kMaxSide, options.shape);
            },
            "width and height (320x240)")
        .type_name("WxH");
    command.add_option("--seed", options.seed, "textures and arrangement (1)")
        .check(whole_check(0))
        .type_name("S");
}

}  // namespace stipple
