#include "io/video_decoder.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string_view>
#include <type_traits>

#include "core/error.h"
#include "core/memory_limit.h"
#include "io/lazy_ffmpeg.h"

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libavutil/display.h>
#include <libavutil/mem.h>
}

namespace stipple {
namespace {

STIPPLE_LAZY(av_dict_free);
STIPPLE_LAZY(av_dict_set);
STIPPLE_LAZY(av_display_rotation_get);
STIPPLE_LAZY(av_find_best_stream);
STIPPLE_LAZY(av_frame_alloc);
STIPPLE_LAZY(av_log_set_callback);
STIPPLE_LAZY(av_max_alloc);
STIPPLE_LAZY(av_packet_alloc);
STIPPLE_LAZY(av_packet_unref);
STIPPLE_LAZY(av_read_frame);
STIPPLE_LAZY(av_stream_get_side_data);
STIPPLE_LAZY(avcodec_alloc_context3);
STIPPLE_LAZY(avcodec_get_class);
STIPPLE_LAZY(avcodec_open2);
STIPPLE_LAZY(avcodec_parameters_to_context);
STIPPLE_LAZY(avcodec_receive_frame);
STIPPLE_LAZY(avcodec_send_packet);
STIPPLE_LAZY(avformat_find_stream_info);
STIPPLE_LAZY(avformat_open_input);

/// Containers announce a number of frames or a duration, which may be off by some frames.
constexpr double kMinFractionOfAnnounced = 0.9;
constexpr std::uint64_t kBytesAPixel = 12;  ///< at most: three of 16 bits, and converted

/// Errors that a decoder logs. Some decoders tell of damage nowhere else.
struct LoggedErrors {
    std::atomic<int> count = 0;
    std::atomic<int> first_frame = 0;  ///< the frame that came next when the first was logged
    int next_frame = 0;
};

/// In place of FFmpeg's own log on standard error.
void log_to_decoder(void* context, int level, const char* /*format*/, va_list /*arguments*/) {
    if (context == nullptr || level > AV_LOG_ERROR) return;
    if (*static_cast<const AVClass* const*>(context) != avcodec_get_class()) return;
    auto* const errors = static_cast<LoggedErrors*>(static_cast<AVCodecContext*>(context)->opaque);
    if (errors != nullptr && errors->count++ == 0) errors->first_frame = errors->next_frame;
}

/// FFmpeg's blocks have at most this part of the memory that the input may take. Some hundred bytes
/// may ask for frames of 2^28 pixels, which FFmpeg unpacks before it tells of them.
enum class BlockShare : std::uint8_t {
    kProbe = 16,  ///< frames that FFmpeg decodes to examine the file: planes of several
    kDecode = 2,  ///< a frame of packed pixels, and what it is converted to
};

void limit_blocks(std::uint64_t file_bytes, BlockShare share) {
    av_max_alloc(max_memory(file_bytes) / static_cast<unsigned>(share));
}

FfmpegPtr<AVFormatContext> open_file(const std::string& name) {
    AVFormatContext* file = nullptr;
    AVDictionary* options = nullptr;
    av_dict_set(&options, "protocol_whitelist", "file", 0);
    // "file:" before it, for a name may have a colon.
    int error = avformat_open_input(&file, ("file:" + name).c_str(), nullptr, &options);
    av_dict_free(&options);
    FfmpegPtr<AVFormatContext> opened(file);
    if (error >= 0) error = avformat_find_stream_info(file, nullptr);
    if (error < 0)
        throw InputError(name, fmt::format("cannot be read as video ({}); it is damaged, ends too "
                                           "early or is not a video",
                                           ffmpeg_reason(error)));
    return opened;
}

/// FFmpeg keeps the codes of a file in its enumerations, unknown ones too, which C++ may not read
/// as such. \returns `code`; `unspecified` for a code of `end` or more.
template <typename Code>
Code known(const Code& code, Code end, Code unspecified) {
    std::underlying_type_t<Code> value{};
    std::memcpy(&value, &code, sizeof value);
    return value < static_cast<std::underlying_type_t<Code>>(end) ? code : unspecified;
}

/// What a frame does not declare of its colours, its container may.
template <typename Code>
void complete(Code& code, const Code& container, Code end, Code unspecified) {
    code = known(code, end, unspecified);
    if (code == unspecified) code = known(container, end, unspecified);
}

void complete_colours(AVFrame& frame, const AVCodecParameters& container) {
    complete(frame.colorspace, container.color_space, AVCOL_SPC_NB, AVCOL_SPC_UNSPECIFIED);
    complete(frame.color_range, container.color_range, AVCOL_RANGE_NB, AVCOL_RANGE_UNSPECIFIED);
    complete(frame.color_trc, container.color_trc, AVCOL_TRC_NB, AVCOL_TRC_UNSPECIFIED);
    complete(frame.color_primaries, container.color_primaries, AVCOL_PRI_NB, AVCOL_PRI_UNSPECIFIED);
}

}  // namespace

struct VideoDecoder::Impl {
    std::string name;
    LoggedErrors errors;
    FfmpegPtr<AVFormatContext> file;
    const AVStream* stream = nullptr;
    FfmpegPtr<AVCodecContext> codec;
    FfmpegPtr<AVPacket> packet{av_packet_alloc()};
    FfmpegPtr<AVFrame> frame{av_frame_alloc()};
    bool ended = false;  ///< the file, not yet the frames
    int packets = 0;     ///< one a frame, those that an edit list hides too
    std::uint64_t file_bytes = 0;
    std::uint64_t packets_end = 0;  ///< byte after the last packet of the video
    /// When the first packet begins and the last one ends: of any stream if only the file has a
    /// duration. FFmpeg's start of a stream may be that of a later frame where frames are
    /// reordered.
    double begin_s = std::numeric_limits<double>::max();
    double end_s = std::numeric_limits<double>::lowest();
    std::string shortfall;
    FrameTimes times;

    void open(const std::filesystem::path& path);
    void send_packet();
    void check_end();
    void count_packet();
    void check_fields() const;
    [[nodiscard]] std::optional<double> frames_hz() const;
    [[nodiscard]] double announced_s() const;
    [[noreturn]] void fail(const std::string& problem) const {
        throw InputError(fmt::format("{}: frame {}", name, errors.next_frame),
                         problem + "; repair or cut the video first");
    }
};

void VideoDecoder::Impl::open(const std::filesystem::path& path) {
    av_log_set_callback(log_to_decoder);
    name = path.string();
    file_bytes = input_bytes(path);
    limit_blocks(file_bytes, BlockShare::kProbe);
    file = open_file(name);
    limit_blocks(file_bytes, BlockShare::kDecode);
    const AVCodec* decoder = nullptr;
    const int index = av_find_best_stream(file.get(), AVMEDIA_TYPE_VIDEO, -1, -1, &decoder, 0);
    if (index < 0)
        throw InputError(name, index == AVERROR_DECODER_NOT_FOUND
                                   ? "is coded in a way that FFmpeg here cannot decode"
                                   : "holds no video");
    stream = file->streams[index];
    times = FrameTimes(av_q2d(stream->time_base), frames_hz());
    const AVCodecParameters& announced = *stream->codecpar;
    if (announced.width > 0 && announced.height > 0)
        check_memory(kBytesAPixel * static_cast<std::uint64_t>(announced.width) *
                         static_cast<std::uint64_t>(announced.height),
                     name, "a frame", file_bytes);
    codec.reset(avcodec_alloc_context3(decoder));
    avcodec_parameters_to_context(codec.get(), stream->codecpar);
    codec->opaque = &errors;
    codec->flags |= AV_CODEC_FLAG_OUTPUT_CORRUPT | AV_CODEC_FLAG_BITEXACT;
    codec->err_recognition |= AV_EF_CRCCHECK;
    // Frames may grow, and a decoder keeps several.
    codec->max_pixels = static_cast<std::int64_t>(max_memory(file_bytes) / kBytesAPixel);
    codec->thread_count = 0;
    codec->thread_type = FF_THREAD_SLICE;  // decoders in one context each log which frame is wrong
    const int error = avcodec_open2(codec.get(), decoder, nullptr);
    if (error < 0) throw InputError(name, "cannot be decoded: " + ffmpeg_reason(error));
}

/// Gives the decoder what it needs for more frames.
void VideoDecoder::Impl::send_packet() {
    int error = 0;
    do {
        av_packet_unref(packet.get());
        error = av_read_frame(file.get(), packet.get());
        if (error >= 0) count_packet();
    } while (error >= 0 && (packet->stream_index != stream->index || packet->size == 0));
    if (error < 0 && error != AVERROR_EOF) fail("cannot be read: " + ffmpeg_reason(error));
    ended = error < 0;
    if (!ended && (packet->flags & AV_PKT_FLAG_CORRUPT) != 0) fail("is damaged or cut short");
    error = avcodec_send_packet(codec.get(), ended ? nullptr : packet.get());
    if (error < 0) fail("is damaged: " + ffmpeg_reason(error));
}

void VideoDecoder::Impl::count_packet() {
    const bool of_video = packet->stream_index == stream->index;
    if (of_video) ++packets;
    if (of_video && packet->pos >= 0)
        packets_end =
            static_cast<std::uint64_t>(packet->pos) + static_cast<std::uint64_t>(packet->size);
    if (packet->pts == AV_NOPTS_VALUE || (stream->duration > 0 && !of_video)) return;
    const AVStream& own = *file->streams[packet->stream_index];
    const std::int64_t first = own.start_time == AV_NOPTS_VALUE ? 0 : own.start_time;
    const double tick_s = av_q2d(own.time_base);
    begin_s = std::min(begin_s, static_cast<double>(std::min(first, packet->pts)) * tick_s);
    end_s = std::max(end_s, static_cast<double>(packet->pts + packet->duration) * tick_s);
}

/// Of the video, else of the whole file; not above 0 if unknown.
double VideoDecoder::Impl::announced_s() const {
    return stream->duration > 0 ? static_cast<double>(stream->duration) * av_q2d(stream->time_base)
                                : static_cast<double>(file->duration) / AV_TIME_BASE;
}

/// Compares what was read with what the container announces: frames, else their time.
void VideoDecoder::Impl::check_end() {
    if (errors.next_frame == 0)
        throw InputError(name, "holds no frame; it is damaged or ends too early");
    // FFmpeg drops a part of a frame without a word, and .y4m announces no number of frames.
    const bool is_y4m = std::string_view(file->iformat->name) == "yuv4mpegpipe";
    if (is_y4m && file_bytes != kEndlessInput && file_bytes > packets_end)
        throw InputError(name, fmt::format("ends within frame {}; it is truncated or damaged",
                                           errors.next_frame));
    const bool counts = stream->nb_frames > 0;
    const double announced = counts ? static_cast<double>(stream->nb_frames) : announced_s();
    const double length_s = std::max(0.0, end_s - begin_s);
    const double found = counts ? packets : length_s;
    const double one_frame = counts ? 1 : length_s / packets;
    if (found >= announced - 1.5 * one_frame) return;
    const std::string text =
        counts ? fmt::format("ends after {} of {} frames", packets, stream->nb_frames)
               : fmt::format("ends after {} frames, at {:.3f} of {:.3f} s", packets, length_s,
                             announced);
    if (found < kMinFractionOfAnnounced * announced)
        throw InputError(name, text + "; it is truncated or damaged");
    shortfall = fmt::format("{}: {}; frames may be missing", name, text);
}

/// \throws InputError if the frame holds two moments. A container may declare what a decoder does
/// not tell, and the reverse.
void VideoDecoder::Impl::check_fields() const {
    constexpr auto kEnd = static_cast<AVFieldOrder>(AV_FIELD_BT + 1);
    const AVFieldOrder order = known(stream->codecpar->field_order, kEnd, AV_FIELD_UNKNOWN);
    const bool declared = order != AV_FIELD_UNKNOWN && order != AV_FIELD_PROGRESSIVE;
    if (declared || frame->interlaced_frame != 0)
        throw InputError(fmt::format("{}: frame {}", name, errors.next_frame),
                         "is interlaced, so its even and odd rows are of two moments; make a frame "
                         "of each first: ffmpeg -i VIDEO -vf bwdif OUT.mkv");
}

VideoDecoder::VideoDecoder(const std::filesystem::path& file) : impl_(std::make_unique<Impl>()) {
    impl_->open(file);
}

VideoDecoder::~VideoDecoder() = default;
VideoDecoder::VideoDecoder(VideoDecoder&&) noexcept = default;
VideoDecoder& VideoDecoder::operator=(VideoDecoder&&) noexcept = default;

const AVFrame* VideoDecoder::next() {
    AVFrame& frame = *impl_->frame;
    int error = avcodec_receive_frame(impl_->codec.get(), &frame);
    for (; error == AVERROR(EAGAIN) && !impl_->ended;
         error = avcodec_receive_frame(impl_->codec.get(), &frame))
        impl_->send_packet();
    if (error == AVERROR_EOF) {
        impl_->check_end();
        return nullptr;
    }
    if (error < 0) impl_->fail("is damaged: " + ffmpeg_reason(error));
    if (frame.decode_error_flags != 0 || (frame.flags & AV_FRAME_FLAG_CORRUPT) != 0)
        impl_->fail("is damaged: parts of it are missing or made up");
    impl_->check_fields();
    ++impl_->errors.next_frame;
    const std::int64_t tick = frame.best_effort_timestamp;
    impl_->times.add(tick == AV_NOPTS_VALUE ? std::nullopt : std::optional(tick));
    complete_colours(frame, *impl_->stream->codecpar);
    return &frame;
}

std::optional<double> VideoDecoder::Impl::frames_hz() const {
    constexpr double kMaxHz = 80'000;  // where a container has no rate: the tick of its time stamps
    const AVRational rate = stream->avg_frame_rate;
    if (rate.num <= 0 || rate.den <= 0 || av_q2d(rate) >= kMaxHz) return {};
    return av_q2d(rate);
}

std::optional<double> VideoDecoder::frames_hz() const {
    return impl_->frames_hz();
}

std::optional<std::int64_t> VideoDecoder::announced_frames() const {
    const std::int64_t frames = impl_->stream->nb_frames;
    return frames > 0 ? std::optional(frames) : std::nullopt;
}

double VideoDecoder::frame_time() const {
    return impl_->times.time();
}

std::string VideoDecoder::unequal_times() const {
    return impl_->times.unequal();
}

int VideoDecoder::quarter_turns() const {
    const auto* const matrix = reinterpret_cast<const std::int32_t*>(
        av_stream_get_side_data(impl_->stream, AV_PKT_DATA_DISPLAYMATRIX, nullptr));
    if (matrix == nullptr) return 0;
    const double quarters = av_display_rotation_get(matrix) / 90;
    const double determinant =
        static_cast<double>(matrix[0]) * matrix[4] - static_cast<double>(matrix[1]) * matrix[3];
    if (!(determinant > 0) || quarters != std::round(quarters))
        throw InputError(impl_->name,
                         "is to be shown mirrored, or turned by another angle than 90, 180 or 270 "
                         "degrees; convert it first, e.g. by ffmpeg");
    return (static_cast<int>(quarters) + 4) % 4;
}

std::vector<Message> VideoDecoder::warnings() const {
    std::vector<Message> texts;
    const int count = impl_->errors.count;
    if (count > 0)
        texts.push_back(fmt::format(
            "{}: the decoder reports {} error{}, the first at frame {}: "
            "frames from there on may be wrong",
            impl_->name, count, count == 1 ? "" : "s", impl_->errors.first_frame.load()));
    const AVRational of_stream = impl_->stream->sample_aspect_ratio;
    const AVRational pixel = of_stream.num > 0 ? of_stream : impl_->codec->sample_aspect_ratio;
    if (pixel.num > 0 && pixel.den > 0 && pixel.num != pixel.den)
        texts.push_back(fmt::format(
            "{}: declares pixels {:.4g} times as wide as high; they are taken for square ones",
            impl_->name, av_q2d(pixel)));
    if (!impl_->shortfall.empty()) texts.emplace_back(impl_->shortfall);
    return texts;
}

}  // namespace stipple
