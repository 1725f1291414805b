#include "apps/arguments/footage.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>

#include "apps/arguments/checks.h"
#include "apps/report/session_report.h"
#include "core/error.h"
#include "decoder/portz2013/late_opencv.h"
#include "io/frame_resampler.h"
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

void add_resample_arguments(Command& command, ResampleChoice& choice, FootageOptions& options) {
    constexpr double kMinHz = 0.001;
    constexpr double kMaxHz = 1e9;
    command
        .add_option("--resample", choice.method,
                    "make slots of frames of another rate: hold the frame before, blend light, or "
                    "move it by optical flow (each frame is a slot)")
        .one_of({"hold", "blend", "flow"})
        .type_name("METHOD");
    command
        .add_option("--footage-hz", options.frames_hz,
                    "frame rate of the footage, instead of that in its file")
        .check(number_check(kMinHz, kMaxHz))
        .type_name("HZ");
    command.add_option("--scale", options.scale, "multiply light by this: the exposure (1)")
        .check(positive_check())
        .type_name("FACTOR");
}

SlotSource slots_of(ReadAhead& footage, const std::string& source, const ResampleChoice& choice,
                    const FootageOptions& options, double slot_us) {
    if (choice.method.empty()) return {[&footage] { return footage.next(); }, footage.slots()};
    const auto hz = options.frames_hz ? options.frames_hz : footage.video_hz();
    if (!hz)
        throw InputError(source, "does not tell its frame rate; --resample needs --footage-hz");
    const bool flow = choice.method == "flow";
    if (flow && footage.filter() != ColourFilter::kNone)
        throw InputError(source,
                         "is the mosaic of a colour filter array, whose colours --resample flow "
                         "would mix; use blend");
    const FrameShape shape = footage.shape();
    const double frames_per_slot = *hz * slot_us * 1e-6;
    const bool is_small = std::min(shape.rows, shape.cols) < kMinDisFlowSide;
    const auto resampler = std::make_shared<FrameResampler>(
        shape,
        ResamplingOptions{.method = flow                       ? Resampling::kFlow
                                    : choice.method == "blend" ? Resampling::kBlend
                                                               : Resampling::kHold,
                          .frames_per_slot = frames_per_slot,
                          .flow = is_small ? FlowFunction() : dis_flow},
        [&footage] { return footage.next(); });
    SlotSource slots{[resampler] { return resampler->next(); }, {}};
    if (const auto frames = footage.slots())
        slots.slots = static_cast<int>(std::min<std::int64_t>(
            resampled_slots(*frames, frames_per_slot), std::numeric_limits<int>::max()));
    return slots;
}

void check_recording_options(const std::string& recording, const FootageOptions& options) {
    if (options.transfer.value_or(Transfer::kLinear) != Transfer::kLinear || options.luminance ||
        options.max_value || options.raw || options.scale != 1)
        throw InputError(recording,
                         "is a recording of a camera, whose numbers are linear: --transfer, --raw, "
                         "--luminance, --scale and --max-value are for other footage");
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
