#include "io/video_planes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/error.h"
#include "core/light.h"
#include "io/interleaved.h"
#include "io/lazy_ffmpeg.h"

extern "C" {
#include <libavutil/frame.h>
#include <libavutil/pixdesc.h>
#include <libswscale/swscale.h>
}

namespace stipple {
namespace {

STIPPLE_LAZY(av_color_primaries_name);
STIPPLE_LAZY(av_color_space_name);
STIPPLE_LAZY(av_color_transfer_name);
STIPPLE_LAZY(av_frame_alloc);
STIPPLE_LAZY(av_frame_get_buffer);
STIPPLE_LAZY(av_pix_fmt_desc_get);
STIPPLE_LAZY(sws_getCoefficients);
STIPPLE_LAZY(sws_getContext);
STIPPLE_LAZY(sws_isSupportedInput);
STIPPLE_LAZY(sws_scale);
STIPPLE_LAZY(sws_setColorspaceDetails);

enum class Colours { kGrey, kYcbcr, kRgb };

/// Y' = red R + (1 - red - blue) G + blue B.
struct LumaWeights {
    float red;
    float blue;
};

const AVPixFmtDescriptor& checked_format(const AVFrame& frame, const std::string& name) {
    const auto format = static_cast<AVPixelFormat>(frame.format);
    const AVPixFmtDescriptor* const about = av_pix_fmt_desc_get(format);
    const bool is_xyz = format == AV_PIX_FMT_XYZ12LE || format == AV_PIX_FMT_XYZ12BE;
    constexpr std::uint64_t kWithoutNumbers = AV_PIX_FMT_FLAG_FLOAT | AV_PIX_FMT_FLAG_HWACCEL;
    if (about == nullptr || is_xyz || (about->flags & kWithoutNumbers) != 0 ||
        (about->nb_components < 3 && about->comp[0].depth < 8) || sws_isSupportedInput(format) == 0)
        throw InputError(name,
                         fmt::format("its pixels are of the format \"{}\", which is not read; "
                                     "give grey, RGB or Y'CbCr of 8 to 16 bits",
                                     about == nullptr ? "unknown" : about->name));
    return *about;
}

Colours colours_of(const AVPixFmtDescriptor& about) {
    constexpr std::uint64_t kRgb =
        AV_PIX_FMT_FLAG_RGB | AV_PIX_FMT_FLAG_PAL | AV_PIX_FMT_FLAG_BAYER;
    if ((about.flags & kRgb) != 0) return Colours::kRgb;
    return about.nb_components < 3 ? Colours::kGrey : Colours::kYcbcr;
}

/// H.273, table 4.
LumaWeights luma_weights(const AVFrame& frame, const std::string& name) {
    constexpr LumaWeights kBt601{0.299F, 0.114F};
    constexpr LumaWeights kBt709{0.2126F, 0.0722F};
    constexpr int kMinRowsOfBt709 = 720;
    switch (frame.colorspace) {
        case AVCOL_SPC_BT709:
            return kBt709;
        case AVCOL_SPC_BT470BG:
        case AVCOL_SPC_SMPTE170M:
            return kBt601;
        case AVCOL_SPC_FCC:
            return {0.30F, 0.11F};
        case AVCOL_SPC_SMPTE240M:
            return {0.212F, 0.087F};
        case AVCOL_SPC_BT2020_NCL:
            return {0.2627F, 0.0593F};
        case AVCOL_SPC_UNSPECIFIED:
        case AVCOL_SPC_RESERVED:
            return frame.height >= kMinRowsOfBt709 ? kBt709 : kBt601;
        default:
            throw InputError(name, fmt::format("its colours are coded by the matrix \"{}\"; give "
                                               "BT.601, BT.709 or BT.2020 (not constant luminance)",
                                               av_color_space_name(frame.colorspace)));
    }
}

bool is_full_range(const AVFrame& frame, Colours colours) {
    switch (frame.format) {
        case AV_PIX_FMT_YUVJ411P:
        case AV_PIX_FMT_YUVJ420P:
        case AV_PIX_FMT_YUVJ422P:
        case AV_PIX_FMT_YUVJ440P:
        case AV_PIX_FMT_YUVJ444P:
            return true;
        default:
            return frame.color_range == AVCOL_RANGE_JPEG ||
                   (frame.color_range == AVCOL_RANGE_UNSPECIFIED && colours == Colours::kGrey);
    }
}

/// How 16-bit numbers, which are those of `depth` bits times 2^(16 - depth), become 0..1 and, for
/// the differences of colour, -0.5..0.5. H.273, 8.3.
struct Scale {
    float black;
    float luma;
    float chroma;

    Scale(int depth, bool full_range) {
        const auto unit = static_cast<float>(1 << (16 - depth));  // 1 at `depth` bits
        const float full = unit * static_cast<float>((1 << depth) - 1);
        black = full_range ? 0.0F : 16.0F * 256;
        luma = 1 / (full_range ? full : 219.0F * 256);
        chroma = 1 / (full_range ? full : 224.0F * 256);
    }
};

/// The name of primaries far from those of Rec. 709; those of SD video are near.
std::string other_primaries(AVColorPrimaries primaries) {
    switch (primaries) {
        case AVCOL_PRI_FILM:
        case AVCOL_PRI_BT2020:
        case AVCOL_PRI_SMPTE428:
        case AVCOL_PRI_SMPTE431:
        case AVCOL_PRI_SMPTE432:
            return av_color_primaries_name(primaries);
        default:
            return {};
    }
}

/// What a frame declares of its curve goes first. Where it declares none, all but grey and RGB of
/// more than 8 bits are gamma-coded, as is usual.
SourceInfo traits_of(const AVFrame& frame, const AVPixFmtDescriptor& about) {
    const AVColorTransferCharacteristic curve = frame.color_trc;
    const bool is_declared = curve != AVCOL_TRC_UNSPECIFIED && curve != AVCOL_TRC_RESERVED0;
    SourceInfo traits;
    traits.gamma_coded = is_declared
                             ? curve != AVCOL_TRC_LINEAR
                             : about.comp[0].depth <= 8 || colours_of(about) == Colours::kYcbcr;
    traits.declared = transfer_of_code(curve);
    if (is_declared && av_color_transfer_name(curve) != nullptr)
        traits.curve = av_color_transfer_name(curve);
    traits.bt2020 = frame.color_primaries == AVCOL_PRI_BT2020;
    if (colours_of(about) != Colours::kGrey)
        traits.primaries = other_primaries(frame.color_primaries);
    traits.sample_format = about.name;
    traits.bits = about.comp[0].depth;
    traits.has_alpha =
        (about.flags & (AV_PIX_FMT_FLAG_ALPHA | AV_PIX_FMT_FLAG_PAL)) == AV_PIX_FMT_FLAG_ALPHA;
    return traits;
}

float clipped(float value) {
    return std::clamp(value, 0.0F, 1.0F);
}

}  // namespace

std::optional<Transfer> transfer_of_code(int code) {
    switch (code) {
        case AVCOL_TRC_BT709:
        case AVCOL_TRC_SMPTE170M:
        case AVCOL_TRC_BT2020_10:
        case AVCOL_TRC_BT2020_12:
            return Transfer::kBt709;
        case AVCOL_TRC_GAMMA22:
            return Transfer::kGamma22;
        case AVCOL_TRC_IEC61966_2_1:
            return Transfer::kSrgb;
        case AVCOL_TRC_LINEAR:
            return Transfer::kLinear;
        case AVCOL_TRC_SMPTE2084:
            return Transfer::kPq;
        case AVCOL_TRC_ARIB_STD_B67:
            return Transfer::kHlg;
        default:
            return {};
    }
}

struct VideoPlanes::Impl {
    int width = 0;
    int height = 0;
    AVPixelFormat format = AV_PIX_FMT_NONE;
    int quarter_turns = 0;
    FrameShape shape;
    Colours colours = Colours::kRgb;
    LumaWeights weights{};
    Scale scale{16, true};
    SourceInfo traits;
    /// The frame as it is stored below, not turned; RGB may be of bytes.
    FfmpegPtr<AVFrame> words{av_frame_alloc()};
    FfmpegPtr<SwsContext> to_words;

    void prepare_words(bool deep, const std::string& name);
    void store_row(int row, std::span<float> planes) const;
    template <typename Sample>
    void store_rgb_row(int row, std::span<float> planes) const;
    /// Where the pixel goes.
    [[nodiscard]] std::size_t turned(int row, int col) const;
    template <typename Sample>
    [[nodiscard]] const Sample* samples(int plane, int row) const {
        return reinterpret_cast<const Sample*>(
            words->data[plane] + static_cast<std::ptrdiff_t>(row) * words->linesize[plane]);
    }
};

/// Room for what swscale makes of a frame: it upsamples the differences of colour and changes no
/// number else (RGB of 8 bits would lose some on its way to 16).
void VideoPlanes::Impl::prepare_words(bool deep, const std::string& name) {
    words->width = width;
    words->height = height;
    words->format = colours == Colours::kGrey    ? AV_PIX_FMT_GRAY16
                    : colours == Colours::kYcbcr ? AV_PIX_FMT_YUV444P16
                    : deep                       ? AV_PIX_FMT_RGB48
                                                 : AV_PIX_FMT_RGB24;
    // The same bits on any processor.
    constexpr int kFlags =
        SWS_BICUBIC | SWS_ACCURATE_RND | SWS_FULL_CHR_H_INT | SWS_FULL_CHR_H_INP | SWS_BITEXACT;
    to_words.reset(sws_getContext(width, height, format, width, height,
                                  static_cast<AVPixelFormat>(words->format), kFlags, nullptr,
                                  nullptr, nullptr));
    if (!to_words || av_frame_get_buffer(words.get(), 0) < 0)
        throw InputError(name,
                         fmt::format("its frames of {} x {} cannot be converted", width, height));
    const int* const matrix = sws_getCoefficients(SWS_CS_DEFAULT);
    constexpr int kOne = 1 << 16;
    if (colours != Colours::kRgb)  // limited to limited range: a mere shift
        sws_setColorspaceDetails(to_words.get(), matrix, 0, matrix, 0, 0, kOne, kOne);
}

std::size_t VideoPlanes::Impl::turned(int row, int col) const {
    const int rows[] = {row, width - 1 - col, height - 1 - row, col};
    const int cols[] = {col, row, width - 1 - col, height - 1 - row};
    return static_cast<std::size_t>(rows[quarter_turns]) * static_cast<std::size_t>(shape.cols) +
           static_cast<std::size_t>(cols[quarter_turns]);
}

template <typename Sample>
void VideoPlanes::Impl::store_rgb_row(int row, std::span<float> planes) const {
    const Sample* from = samples<Sample>(0, row);
    for (int col = 0; col < width; ++col, from += 3) {
        float* const pixel = planes.data() + turned(row, col);
        for (std::size_t plane = 0; plane < 3; ++plane)
            pixel[plane * shape.pixels()] = UnitScale()(from[plane]);
    }
}

/// Of grey or Y'CbCr. H.273, 8.3.
void VideoPlanes::Impl::store_row(int row, std::span<float> planes) const {
    constexpr float kNoColour = 32768;
    const std::size_t pixels = shape.pixels();
    const bool grey = colours == Colours::kGrey;
    const auto* const y = samples<std::uint16_t>(0, row);
    const auto* const cb = grey ? nullptr : samples<std::uint16_t>(1, row);
    const auto* const cr = grey ? nullptr : samples<std::uint16_t>(2, row);
    const float blue_gain = 2 * (1 - weights.blue) * scale.chroma;
    const float red_gain = 2 * (1 - weights.red) * scale.chroma;
    for (int col = 0; col < width; ++col) {
        float* const pixel = planes.data() + turned(row, col);
        const float luma = (static_cast<float>(y[col]) - scale.black) * scale.luma;
        if (grey) {
            *pixel = clipped(luma);
            continue;
        }
        const float blue = luma + blue_gain * (static_cast<float>(cb[col]) - kNoColour);
        const float red = luma + red_gain * (static_cast<float>(cr[col]) - kNoColour);
        const float green =
            (luma - weights.red * red - weights.blue * blue) / (1 - weights.red - weights.blue);
        pixel[0] = clipped(red);
        pixel[pixels] = clipped(green);
        pixel[2 * pixels] = clipped(blue);
    }
}

VideoPlanes::VideoPlanes(const AVFrame& first, int quarter_turns, const std::string& name)
    : impl_(std::make_unique<Impl>()) {
    const AVPixFmtDescriptor& about = checked_format(first, name);
    impl_->width = first.width;
    impl_->height = first.height;
    impl_->format = static_cast<AVPixelFormat>(first.format);
    impl_->quarter_turns = quarter_turns;
    impl_->colours = colours_of(about);
    const bool lies = quarter_turns % 2 != 0;
    impl_->shape = checked_shape(static_cast<std::uint64_t>(lies ? first.width : first.height),
                                 static_cast<std::uint64_t>(lies ? first.height : first.width),
                                 impl_->colours == Colours::kGrey ? 1 : 3, name);
    if (impl_->colours == Colours::kYcbcr) impl_->weights = luma_weights(first, name);
    impl_->scale = Scale(about.comp[0].depth, is_full_range(first, impl_->colours));
    impl_->traits = traits_of(first, about);
    impl_->prepare_words(about.comp[0].depth > 8, name);
}

VideoPlanes::~VideoPlanes() = default;
VideoPlanes::VideoPlanes(VideoPlanes&&) noexcept = default;
VideoPlanes& VideoPlanes::operator=(VideoPlanes&&) noexcept = default;

FrameShape VideoPlanes::shape() const {
    return impl_->shape;
}

const SourceInfo& VideoPlanes::traits() const {
    return impl_->traits;
}

bool VideoPlanes::convert(const AVFrame& frame, std::span<float> planes) {
    if (frame.width != impl_->width || frame.height != impl_->height ||
        frame.format != impl_->format)
        return false;
    sws_scale(impl_->to_words.get(), frame.data, frame.linesize, 0, frame.height,
              impl_->words->data, impl_->words->linesize);
    for (int row = 0; row < impl_->height; ++row) {
        if (impl_->colours != Colours::kRgb)
            impl_->store_row(row, planes);
        else if (impl_->words->format == AV_PIX_FMT_RGB24)
            impl_->store_rgb_row<std::uint8_t>(row, planes);
        else
            impl_->store_rgb_row<std::uint16_t>(row, planes);
    }
    return true;
}

}  // namespace stipple
