#include "apps/arguments/video_output.h"

#include <optional>

#include "apps/arguments/common_options.h"
#include "io/footage_files.h"
#include "io/output_names.h"

namespace stipple {

namespace {

void add_image_arguments(Command& command, ImageCoding& images) {
    constexpr double kMaxPixelUm = 1e6;
    command
        .add_choice(
            "--images", images.format,
            {{"exr", ImageFormat::kExr}, {"png", ImageFormat::kPng}, {"tiff", ImageFormat::kTiff}},
            "of a folder: kind of its images")
        .type_name("exr|png|tiff");
    command
        .add_choice<std::optional<SampleKind>>(
            "--samples", images.samples,
            {{"f32", SampleKind::kFloat}, {"f16", SampleKind::kHalf}, {"u16", SampleKind::kWord}},
            "numbers of images: f32 or f16 of EXR, u16 of PNG, f32 or u16 of TIFF")
        .default_text("the first of these")
        .type_name("f32|f16|u16");
    command
        .add_option("--full-scale", images.full_scale,
                    "with u16: light of code 65535; brighter light is clipped")
        .shows_default()
        .check(positive_check())
        .type_name("LIGHT");
    command.add_option("--pixel-um", images.pixel_um, "with .tif: size of a pixel, for OME-XML")
        .check(number_check(0, kMaxPixelUm))
        .type_name("UM");
}

}  // namespace

void add_video_arguments(Command& command, VideoCoding& video, ImageCoding& images) {
    constexpr double kMinHz = 0.01;
    constexpr double kMaxHz = 10'000;
    constexpr double kMinPeakCd = 100;
    command
        .add_choice("--video", video.curve,
                    {{"sdr", VideoCurve::kSdr}, {"pq", VideoCurve::kPq}, {"hlg", VideoCurve::kHlg}},
                    "of .mp4 and .mkv: tone-mapped, or 10-bit HDR by BT.2100")
        .type_name("sdr|pq|hlg");
    command
        .add_choice("--codec", video.codec, {{"hevc", HdrCodec::kHevc}, {"av1", HdrCodec::kAv1}},
                    "codec of HDR video")
        .type_name("hevc|av1");
    command.add_option("--fps", video.frames_hz, "frames per second at which video plays")
        .shows_default()
        .check(number_check(kMinHz, kMaxHz))
        .type_name("RATE");
    command
        .add_option("--cd-per-unit", video.cd_per_unit,
                    "with HDR video: luminance of light 1.0 in cd/m2")
        .shows_default()
        .check(positive_check())
        .type_name("L");
    command
        .add_option("--peak-cd", video.peak_cd, "with --video pq: clip to this luminance, in cd/m2")
        .shows_default()
        .check(number_check(kMinPeakCd, kPqMaxCd))
        .type_name("L");
    add_image_arguments(command, images);
}

void check_video_arguments(const Command& command, const VideoCoding& video,
                           const ImageCoding& images, const std::string& output) {
    const std::string extension = lower_extension(output);
    const bool is_stack = extension == ".tif" || extension == ".tiff";
    const bool is_y4m = extension == ".y4m" || is_pipe(output);
    const bool is_video = is_y4m || extension == ".mp4" || extension == ".mkv";
    if (is_video || is_stack || extension == ".npy")
        command.refuse({"--images"}, "needs a folder of images as output");
    if (is_video || extension == ".npy")
        command.refuse({"--samples", "--full-scale"},
                       "needs a folder of images or a .tif as output");
    if (!is_stack) command.refuse({"--pixel-um"}, "needs a .tif as output");
    const bool png = images.format == ImageFormat::kPng;
    if (images.samples.value_or(png ? SampleKind::kWord : SampleKind::kFloat) != SampleKind::kWord)
        command.refuse({"--full-scale"}, "needs integers; add --samples u16");
    if (!is_video)
        command.refuse({"--video", "--codec", "--fps", "--cd-per-unit", "--peak-cd"},
                       "needs .mp4 or .mkv; this output is linear light");
    if (is_y4m)
        command.refuse({"--video", "--codec", "--cd-per-unit", "--peak-cd"},
                       "needs .mp4 or .mkv; .y4m and pipes are tone-mapped video");
    if (video.curve == VideoCurve::kSdr)
        command.refuse({"--codec", "--cd-per-unit", "--peak-cd"},
                       "needs HDR video; add --video pq or --video hlg");
    if (video.curve == VideoCurve::kHlg)
        command.refuse({"--peak-cd"}, "needs --video pq; the peak of HLG is that of the display");
}

}  // namespace stipple
