#include "io/video_writer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <new>

#include "core/error.h"

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libavutil/mastering_display_metadata.h>
#include <libavutil/mem.h>
}

namespace stipple {
namespace {

STIPPLE_LAZY(av_content_light_metadata_alloc);
STIPPLE_LAZY(av_d2q);
STIPPLE_LAZY(av_dict_free);
STIPPLE_LAZY(av_dict_set);
STIPPLE_LAZY(av_freep);
STIPPLE_LAZY(av_mastering_display_metadata_alloc);
STIPPLE_LAZY(av_stream_add_side_data);
STIPPLE_LAZY(avcodec_alloc_context3);
STIPPLE_LAZY(avcodec_find_encoder);
STIPPLE_LAZY(avcodec_find_encoder_by_name);
STIPPLE_LAZY(avcodec_open2);

/// Of the encoder, whose bits depend on it: the same on any machine.
constexpr int kThreads = 4;
constexpr double kMinDisplayCd = 0.0001;  ///< the least that ST 2086 can express

// Chromaticities of ST 2086, in units of 0.00002. The colours lie within BT.709.
constexpr int kChromaticityUnits = 50'000;
constexpr double kLuminanceUnits = 10'000;
constexpr int kRed[] = {32'000, 16'500};
constexpr int kGreen[] = {15'000, 30'000};
constexpr int kBlue[] = {7'500, 3'000};
constexpr int kWhite[] = {15'635, 16'450};

const AVCodec* find_encoder(const VideoCoding& coding, const std::string& where) {
    const bool sdr = coding.curve == VideoCurve::kSdr;
    const bool hevc = coding.codec == HdrCodec::kHevc;
    const AVCodec* const codec =
        sdr ? avcodec_find_encoder(coding.uncompressed ? AV_CODEC_ID_WRAPPED_AVFRAME
                                                       : AV_CODEC_ID_H264)
            : avcodec_find_encoder_by_name(hevc ? "libx265" : "libaom-av1");
    if (codec == nullptr)
        throw DeviceError(
            where, fmt::format("FFmpeg here has no encoder for {}", sdr    ? "H.264"
                                                                    : hevc ? "HEVC (libx265)"
                                                                           : "AV1 (libaom)"));
    return codec;
}

/// Tone-mapped numbers have sRGB's primaries and the power 1/2.2.
void declare_colours(AVCodecContext& encoder, VideoCurve curve) {
    const bool sdr = curve == VideoCurve::kSdr;
    encoder.color_range = AVCOL_RANGE_MPEG;
    encoder.colorspace = sdr ? AVCOL_SPC_BT709 : AVCOL_SPC_BT2020_NCL;
    encoder.color_primaries = sdr ? AVCOL_PRI_BT709 : AVCOL_PRI_BT2020;
    encoder.color_trc = sdr                        ? AVCOL_TRC_GAMMA22
                        : curve == VideoCurve::kPq ? AVCOL_TRC_SMPTE2084
                                                   : AVCOL_TRC_ARIB_STD_B67;
    if (!sdr) encoder.chroma_sample_location = AVCHROMA_LOC_LEFT;
}

/// x265 writes to standard error itself, unless it is told not to.
std::string x265_parameters(const VideoCoding& coding) {
    std::string text = fmt::format("log-level=none:info=0:pools={}:frame-threads=1", kThreads);
    if (coding.curve == VideoCurve::kPq)
        text += fmt::format(
            ":hdr10=1:max-cll={},{}"
            ":master-display=G({},{})B({},{})R({},{})WP({},{})L({:.0f},{:.0f})",
            kUnknownMaxCll, kUnknownMaxFall, kGreen[0], kGreen[1], kBlue[0], kBlue[1], kRed[0],
            kRed[1], kWhite[0], kWhite[1], coding.peak_cd * kLuminanceUnits,
            kMinDisplayCd * kLuminanceUnits);
    return text;
}

/// libx265 3.5 writes beyond its memory for pictures that are smaller than its blocks.
void check_size(FrameShape shape, const VideoCoding& coding, const std::string& where) {
    constexpr int kMinSide = 64;
    const bool hevc = coding.curve != VideoCurve::kSdr && coding.codec == HdrCodec::kHevc;
    if (!hevc || std::min(shape.rows, shape.cols) >= kMinSide) return;
    throw InputError(where,
                     fmt::format("frames of {} x {} are too small for HEVC, which is encoded "
                                 "from {} x {} on; AV1 (",
                                 shape.cols, shape.rows, kMinSide, kMinSide) +
                         Parameter{"codec", "av1"} + ") is for any size");
}

AVDictionary* options_of(const VideoCoding& coding) {
    AVDictionary* options = nullptr;
    if (coding.uncompressed) return options;
    if (coding.curve == VideoCurve::kSdr) {
        av_dict_set(&options, "crf", "23", 0);  // x264's default
        // On processors with AVX-512 this step of libx264 r3095 reads memory that nothing was
        // written to: bits would differ from run to run.
        av_dict_set(&options, "mbtree", "0", 0);
    } else if (coding.codec == HdrCodec::kHevc) {
        av_dict_set(&options, "crf", "18", 0);
        av_dict_set(&options, "x265-params", x265_parameters(coding).c_str(), 0);
    } else {
        av_dict_set(&options, "crf", "20", 0);
        av_dict_set(&options, "cpu-used", "6", 0);
        av_dict_set(&options, "row-mt", "1", 0);
    }
    return options;
}

}  // namespace

FfmpegPtr<AVCodecContext> open_encoder(FrameShape shape, const VideoCoding& coding,
                                       bool global_header, const std::string& where) {
    constexpr int kMaxRateTerm = 60'000;  // numerator, denominator
    check_size(shape, coding, where);
    const AVCodec* const codec = find_encoder(coding, where);
    FfmpegPtr<AVCodecContext> encoder(avcodec_alloc_context3(codec));
    if (!encoder) throw std::bad_alloc();
    // Even, and at least four columns: FFmpeg 5.1 converts narrower frames beyond their memory.
    encoder->width = std::max(shape.cols + shape.cols % 2, 4);
    encoder->height = shape.rows + shape.rows % 2;
    encoder->pix_fmt = coding.curve == VideoCurve::kSdr ? AV_PIX_FMT_YUV420P : AV_PIX_FMT_YUV420P10;
    encoder->framerate = av_d2q(coding.frames_hz, kMaxRateTerm);
    encoder->time_base = av_inv_q(encoder->framerate);
    encoder->thread_count = kThreads;
    declare_colours(*encoder, coding.curve);
    if (global_header) encoder->flags |= AV_CODEC_FLAG_GLOBAL_HEADER;
    AVDictionary* options = options_of(coding);
    const int result = avcodec_open2(encoder.get(), codec, &options);
    av_dict_free(&options);
    if (result < 0)
        throw DeviceError(
            where,
            fmt::format("no video of {} x {} pixels at {} frames per second can be encoded: {}",
                        shape.cols, shape.rows, av_q2d(encoder->framerate), ffmpeg_reason(result)));
    return encoder;
}

void declare_mastering_display(AVStream& stream, const VideoCoding& coding) {
    auto* display = av_mastering_display_metadata_alloc();
    if (display == nullptr) throw std::bad_alloc();
    const int* const primaries[] = {kRed, kGreen, kBlue};
    for (int i = 0; i < 3; ++i)
        for (int axis = 0; axis < 2; ++axis)
            display->display_primaries[i][axis] = {primaries[i][axis], kChromaticityUnits};
    for (int axis = 0; axis < 2; ++axis)
        display->white_point[axis] = {kWhite[axis], kChromaticityUnits};
    const auto luminance = [](double cd) {
        return AVRational{static_cast<int>(std::lround(cd * kLuminanceUnits)),
                          static_cast<int>(kLuminanceUnits)};
    };
    display->min_luminance = luminance(kMinDisplayCd);
    display->max_luminance = luminance(coding.peak_cd);
    display->has_primaries = 1;
    display->has_luminance = 1;
    if (av_stream_add_side_data(&stream, AV_PKT_DATA_MASTERING_DISPLAY_METADATA,
                                reinterpret_cast<std::uint8_t*>(display), sizeof(*display)) < 0) {
        av_freep(&display);
        throw std::bad_alloc();
    }
}

void declare_light_levels(AVStream& stream, unsigned max_cll, unsigned max_fall) {
    std::size_t bytes = 0;
    auto* levels = av_content_light_metadata_alloc(&bytes);
    if (levels == nullptr) throw std::bad_alloc();
    levels->MaxCLL = max_cll;
    levels->MaxFALL = max_fall;
    if (av_stream_add_side_data(&stream, AV_PKT_DATA_CONTENT_LIGHT_LEVEL,
                                reinterpret_cast<std::uint8_t*>(levels), bytes) < 0) {
        av_freep(&levels);
        throw std::bad_alloc();
    }
}

}  // namespace stipple
