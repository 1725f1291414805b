#include "io/video_writer.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <exception>
#include <new>
#include <optional>
#include <string>
#include <vector>

#include "core/error.h"
#include "io/hdr_signal.h"
#include "io/lazy_ffmpeg.h"
#include "io/output_file.h"
#include "io/tone_map.h"

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libavutil/log.h>
#include <libswscale/swscale.h>
}

namespace stipple {
namespace {

STIPPLE_LAZY(av_dict_free);
STIPPLE_LAZY(av_dict_set);
STIPPLE_LAZY(av_frame_alloc);
STIPPLE_LAZY(av_frame_get_buffer);
STIPPLE_LAZY(av_frame_make_writable);
STIPPLE_LAZY(av_interleaved_write_frame);
STIPPLE_LAZY(av_log_set_level);
STIPPLE_LAZY(av_malloc);
STIPPLE_LAZY(av_packet_alloc);
STIPPLE_LAZY(av_packet_rescale_ts);
STIPPLE_LAZY(av_write_trailer);
STIPPLE_LAZY(avcodec_parameters_from_context);
STIPPLE_LAZY(avcodec_receive_packet);
STIPPLE_LAZY(avcodec_send_frame);
STIPPLE_LAZY(avformat_alloc_output_context2);
STIPPLE_LAZY(avformat_new_stream);
STIPPLE_LAZY(avformat_write_header);
STIPPLE_LAZY(avio_alloc_context);
STIPPLE_LAZY(sws_getCoefficients);
STIPPLE_LAZY(sws_getContext);
STIPPLE_LAZY(sws_scale);
STIPPLE_LAZY(sws_setColorspaceDetails);

constexpr int kBufferBytes = 1 << 16;
constexpr const char* kCreate = "cannot be created";

/// The longest header of a file in which light levels are looked for.
constexpr std::size_t kHeadBytes = 1 << 16;

constexpr auto high_byte(unsigned value) {
    return static_cast<std::uint8_t>(value >> 8U);
}
constexpr auto low_byte(unsigned value) {
    return static_cast<std::uint8_t>(value & 0xFFU);
}

/// Light levels in HEVC: a unit of its own (0x4E, 0x01) with the message 144 of four bytes, and the
/// end mark (ITU-T H.265, 7.3.1 and D.2.35).
constexpr std::array<std::uint8_t, 9> hevc_light_levels(unsigned max_cll, unsigned max_fall) {
    return {0x4E,
            0x01,
            144,
            4,
            high_byte(max_cll),
            low_byte(max_cll),
            high_byte(max_fall),
            low_byte(max_fall),
            0x80};
}
constexpr auto kUnknownLevels = hevc_light_levels(kUnknownMaxCll, kUnknownMaxFall);

/// Where the bytes of the file go. A failure must not pass through FFmpeg.
struct Sink {
    OutputFile file;
    std::vector<std::uint8_t> head = {};  ///< the first bytes of the file
    std::size_t position = 0;
    std::vector<std::size_t> unknown_levels = {};  ///< places of kUnknownLevels
    std::size_t equal = 0;                         ///< the last bytes to the first of these
    std::exception_ptr failure = nullptr;

    void write(std::span<const std::uint8_t> bytes) {
        file.write(std::as_bytes(bytes));
        const std::size_t kept = std::min(kHeadBytes, position + bytes.size());
        if (head.size() < kept) head.resize(kept);
        for (std::size_t i = 0; position + i < kept; ++i) head[position + i] = bytes[i];
        for (const std::uint8_t byte : bytes) compare(byte);
    }
    void compare(std::uint8_t byte) {
        ++position;
        if (byte == kUnknownLevels[equal])
            ++equal;
        else
            equal = byte == kUnknownLevels[0] ? 1 : 0;  // which is none of the others
        if (equal < kUnknownLevels.size()) return;
        unknown_levels.push_back(position - equal);
        equal = 0;
    }
    void seek(std::int64_t offset) {
        file.seek(offset);
        equal = 0;
        position = static_cast<std::size_t>(offset);
    }

    template <typename Step>
    bool succeeds(Step step) {
        try {
            step();
            return true;
        } catch (...) {
            failure = std::current_exception();
            return false;
        }
    }
};

int write_bytes(void* opaque, std::uint8_t* bytes, int count) {
    auto& sink = *static_cast<Sink*>(opaque);
    const auto size = static_cast<std::size_t>(count);
    return sink.succeeds([&] { sink.write({bytes, size}); }) ? count : AVERROR(EIO);
}

std::int64_t seek(void* opaque, std::int64_t offset, int whence) {
    auto& sink = *static_cast<Sink*>(opaque);
    if (whence != SEEK_SET) return AVERROR(ENOSYS);
    return sink.succeeds([&] { sink.seek(offset); }) ? offset : AVERROR(EIO);
}

/// A frame of the format with room for its pixels; null if there is no memory.
FfmpegPtr<AVFrame> new_frame(AVPixelFormat format, int width, int height) {
    FfmpegPtr<AVFrame> frame(av_frame_alloc());
    if (!frame) return frame;
    frame->format = format;
    frame->width = width;
    frame->height = height;
    if (av_frame_get_buffer(frame.get(), 0) < 0) frame.reset();
    return frame;
}

/// Of .y4m, which cannot declare it, that which readers take for the size.
int matrix_of(const VideoCoding& coding, int rows) {
    constexpr int kMinRowsOfBt709 = 720;
    if (coding.curve != VideoCurve::kSdr) return SWS_CS_BT2020;
    return coding.uncompressed && rows < kMinRowsOfBt709 ? SWS_CS_ITU601 : SWS_CS_ITU709;
}

/// From grey or RGB of 8 or 16 bits; the same bits on any processor.
FfmpegPtr<SwsContext> new_scaler(const AVFrame& from, const AVFrame& to,
                                 const VideoCoding& coding) {
    constexpr int kFlags =
        SWS_BICUBIC | SWS_ACCURATE_RND | SWS_FULL_CHR_H_INT | SWS_FULL_CHR_H_INP | SWS_BITEXACT;
    constexpr int kOne = 1 << 16;
    FfmpegPtr<SwsContext> scaler(sws_getContext(
        from.width, from.height, static_cast<AVPixelFormat>(from.format), to.width, to.height,
        static_cast<AVPixelFormat>(to.format), kFlags, nullptr, nullptr, nullptr));
    const int* const matrix = sws_getCoefficients(matrix_of(coding, to.height));
    if (scaler) sws_setColorspaceDetails(scaler.get(), matrix, 1, matrix, 0, 0, kOne, kOne);
    return scaler;
}

}  // namespace

struct VideoWriter::Impl {
    std::string where;
    FrameShape shape;
    Sink sink;
    VideoCoding coding;
    std::vector<std::uint8_t> pixels;  ///< as tone-mapped, or of 16 bits in the machine's order
    std::optional<HdrSignal> hdr;
    FfmpegPtr<AVIOContext> bytes;
    FfmpegPtr<AVFormatContext> muxer;
    FfmpegPtr<AVCodecContext> encoder;
    FfmpegPtr<AVPacket> packet;
    FfmpegPtr<AVFrame> padded;   ///< the pixels, and what makes them an even number
    FfmpegPtr<AVFrame> encoded;  ///< in Y'CbCr
    FfmpegPtr<SwsContext> scaler;
    AVStream* stream = nullptr;
    std::int64_t next_slot = 0;

    Impl(const std::filesystem::path& file, std::string_view named, FrameShape frame,
         const VideoCoding& wanted)
        : where(named),
          shape(frame),
          sink{OutputFile(file, where)},
          coding(wanted),
          pixels(frame.sites() * sample_bytes()) {
        if (coding.curve != VideoCurve::kSdr) hdr.emplace(shape, coding);
    }
    [[nodiscard]] std::size_t sample_bytes() const {
        return coding.curve == VideoCurve::kSdr ? sizeof(std::uint8_t) : sizeof(std::uint16_t);
    }
    void open(const std::filesystem::path& file);
    void open_stream();
    void convert(std::span<const float> frame);
    void pad();
    void replace_light_levels(unsigned max_cll, unsigned max_fall);
    void encode(const AVFrame* frame);
    /// \throws what the disk has thrown, else DeviceError, if `result` is an error.
    void check(int result, std::string_view what) const {
        if (sink.failure) std::rethrow_exception(sink.failure);
        if (result < 0)
            throw DeviceError(where, fmt::format("{}: {}", what, ffmpeg_reason(result)));
    }
};

void VideoWriter::Impl::open_stream() {
    stream = avformat_new_stream(muxer.get(), nullptr);
    if (stream == nullptr) throw std::bad_alloc();
    check(avcodec_parameters_from_context(stream->codecpar, encoder.get()), kCreate);
    stream->time_base = encoder->time_base;
    stream->avg_frame_rate = encoder->framerate;
    if (coding.curve != VideoCurve::kSdr && coding.codec == HdrCodec::kHevc)
        stream->codecpar->codec_tag =
            MKTAG('h', 'v', 'c', '1');  // of .mp4, as Apple's players want
    if (coding.curve != VideoCurve::kPq) return;
    declare_mastering_display(*stream, coding);
    declare_light_levels(*stream, kUnknownMaxCll, kUnknownMaxFall);
}

void VideoWriter::Impl::open(const std::filesystem::path& file) {
    av_log_set_level(AV_LOG_QUIET);
    AVFormatContext* created = nullptr;
    const char* const format = coding.uncompressed ? "yuv4mpegpipe" : nullptr;
    check(avformat_alloc_output_context2(&created, nullptr, format, file.c_str()), kCreate);
    muxer.reset(created);
    encoder = open_encoder(shape, coding, (muxer->oformat->flags & AVFMT_GLOBALHEADER) != 0, where);
    packet.reset(av_packet_alloc());
    const bool grey = shape.planes == 1;
    const bool deep = sample_bytes() > 1;
    padded = new_frame(deep ? (grey ? AV_PIX_FMT_GRAY16 : AV_PIX_FMT_RGB48)
                            : (grey ? AV_PIX_FMT_GRAY8 : AV_PIX_FMT_RGB24),
                       encoder->width, encoder->height);
    encoded = new_frame(encoder->pix_fmt, encoder->width, encoder->height);
    if (packet && padded && encoded) scaler = new_scaler(*padded, *encoded, coding);
    auto* const buffer = static_cast<unsigned char*>(av_malloc(kBufferBytes));
    if (buffer != nullptr)
        bytes.reset(avio_alloc_context(buffer, kBufferBytes, 1, &sink, nullptr, write_bytes, seek));
    if (!scaler || !bytes) throw std::bad_alloc();
    open_stream();
    muxer->pb = bytes.get();
    muxer->flags |= AVFMT_FLAG_BITEXACT;  // neither time nor random numbers
    AVDictionary* options = nullptr;
    if (hdr) av_dict_set(&options, "write_crc", "0", 0);  // light levels change later
    const int result = avformat_write_header(muxer.get(), &options);
    av_dict_free(&options);
    check(result, kCreate);
}

void VideoWriter::Impl::convert(std::span<const float> frame) {
    if (!hdr) return tone_map_frame(frame, shape, pixels);
    hdr->convert(frame, {reinterpret_cast<std::uint16_t*>(pixels.data()), shape.sites()});
}

/// Repeats the last row and column.
void VideoWriter::Impl::pad() {
    const std::size_t pixel_bytes = static_cast<std::size_t>(shape.planes) * sample_bytes();
    const std::size_t row_bytes = static_cast<std::size_t>(shape.cols) * pixel_bytes;
    for (int row = 0; row < padded->height; ++row) {
        const std::uint8_t* const from =
            pixels.data() + static_cast<std::size_t>(std::min(row, shape.rows - 1)) * row_bytes;
        std::uint8_t* to = padded->data[0] + static_cast<std::ptrdiff_t>(row) * padded->linesize[0];
        std::memcpy(to, from, row_bytes);
        to += row_bytes;
        for (int col = shape.cols; col < padded->width; ++col, to += pixel_bytes)
            std::memcpy(to, from + row_bytes - pixel_bytes, pixel_bytes);
    }
}

/// Of Matroska, whose header is at the beginning: its elements MaxCLL (55BC) and MaxFALL (55BD),
/// each of two bytes. The header of .mp4 comes last, and has them already. Of HEVC: those in the
/// headers of the stream, which the container holds, and before its key frames.
void VideoWriter::Impl::replace_light_levels(unsigned max_cll, unsigned max_fall) {
    const auto element = [](std::uint8_t id, unsigned value) {
        return std::array<std::uint8_t, 5>{0x55, id, 0x82, high_byte(value), low_byte(value)};
    };
    const auto replace = [&](std::uint8_t id, unsigned unknown, unsigned value) {
        const auto old = element(id, unknown);
        const auto found = std::search(sink.head.begin(), sink.head.end(), old.begin(), old.end());
        if (found == sink.head.end()) return;
        sink.seek(found - sink.head.begin());
        sink.write(element(id, value));
    };
    replace(0xBC, kUnknownMaxCll, max_cll);
    replace(0xBD, kUnknownMaxFall, max_fall);
    for (const std::size_t place : sink.unknown_levels) {
        sink.seek(static_cast<std::int64_t>(place));
        sink.write(hevc_light_levels(max_cll, max_fall));
    }
}

/// Null: what the encoder still holds.
void VideoWriter::Impl::encode(const AVFrame* frame) {
    check(avcodec_send_frame(encoder.get(), frame), "a frame cannot be encoded");
    for (;;) {
        const int result = avcodec_receive_packet(encoder.get(), packet.get());
        if (result == AVERROR(EAGAIN) || result == AVERROR_EOF) return;
        check(result, "a frame cannot be encoded");
        packet->duration = 1;
        packet->stream_index = stream->index;
        av_packet_rescale_ts(packet.get(), encoder->time_base, stream->time_base);
        check(av_interleaved_write_frame(muxer.get(), packet.get()), "cannot be written");
    }
}

VideoWriter::VideoWriter(const std::filesystem::path& file, std::string_view where,
                         FrameShape shape, const VideoCoding& coding)
    : impl_(std::make_unique<Impl>(file, where, shape, coding)) {
    impl_->open(file);
}

VideoWriter::~VideoWriter() = default;
VideoWriter::VideoWriter(VideoWriter&&) noexcept = default;
VideoWriter& VideoWriter::operator=(VideoWriter&&) noexcept = default;

void VideoWriter::write(std::span<const float> frame) {
    impl_->convert(frame);
    impl_->pad();
    const AVFrame& from = *impl_->padded;
    AVFrame& to = *impl_->encoded;
    impl_->check(av_frame_make_writable(&to), "a frame cannot be encoded");
    sws_scale(impl_->scaler.get(), from.data, from.linesize, 0, from.height, to.data, to.linesize);
    to.pts = impl_->next_slot++;
    impl_->encode(&to);
}

std::optional<LightLevels> VideoWriter::light_levels() const {
    if (impl_->coding.curve != VideoCurve::kPq) return {};
    return impl_->hdr->levels();
}

void VideoWriter::finish() {
    impl_->encode(nullptr);
    const LightLevels levels = light_levels().value_or(LightLevels{});
    auto max_cll = static_cast<unsigned>(std::max(1.0, std::ceil(levels.max_cll)));
    const auto max_fall = static_cast<unsigned>(std::ceil(levels.max_fall));
    // HEVC has an escape for two zero bytes in a row, which would take another byte.
    if (low_byte(max_cll) == 0 && high_byte(max_fall) == 0) ++max_cll;
    const bool is_pq = impl_->coding.curve == VideoCurve::kPq;
    if (is_pq) declare_light_levels(*impl_->stream, max_cll, max_fall);
    impl_->check(av_write_trailer(impl_->muxer.get()), "cannot be written");
    if (is_pq) impl_->replace_light_levels(max_cll, max_fall);
    impl_->sink.file.close();
}

}  // namespace stipple
