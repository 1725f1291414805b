#include "io/video_writer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <exception>
#include <new>
#include <string>
#include <vector>

#include "core/error.h"
#include "io/late_ffmpeg.h"
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

STIPPLE_LATE(av_d2q);
STIPPLE_LATE(av_dict_free);
STIPPLE_LATE(av_dict_set);
STIPPLE_LATE(av_frame_alloc);
STIPPLE_LATE(av_frame_get_buffer);
STIPPLE_LATE(av_frame_make_writable);
STIPPLE_LATE(av_interleaved_write_frame);
STIPPLE_LATE(av_log_set_level);
STIPPLE_LATE(av_malloc);
STIPPLE_LATE(av_packet_alloc);
STIPPLE_LATE(av_packet_rescale_ts);
STIPPLE_LATE(av_write_trailer);
STIPPLE_LATE(avcodec_alloc_context3);
STIPPLE_LATE(avcodec_find_encoder);
STIPPLE_LATE(avcodec_open2);
STIPPLE_LATE(avcodec_parameters_from_context);
STIPPLE_LATE(avcodec_receive_packet);
STIPPLE_LATE(avcodec_send_frame);
STIPPLE_LATE(avformat_alloc_output_context2);
STIPPLE_LATE(avformat_new_stream);
STIPPLE_LATE(avformat_write_header);
STIPPLE_LATE(avio_alloc_context);
STIPPLE_LATE(sws_getCoefficients);
STIPPLE_LATE(sws_getContext);
STIPPLE_LATE(sws_scale);
STIPPLE_LATE(sws_setColorspaceDetails);

/// Of the encoder, whose bits depend on it: the same on any machine.
constexpr int kThreads = 4;
constexpr const char* kQuality = "23";  ///< constant rate factor, x264's default
constexpr int kBufferBytes = 1 << 16;

/// Where the bytes of the file go. A failure must not pass through FFmpeg.
struct Sink {
    OutputFile file;
    std::exception_ptr failure = nullptr;

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
    return sink.succeeds([&] { sink.file.write(std::as_bytes(std::span(bytes, size))); })
               ? count
               : AVERROR(EIO);
}

std::int64_t seek(void* opaque, std::int64_t offset, int whence) {
    auto& sink = *static_cast<Sink*>(opaque);
    if (whence != SEEK_SET) return AVERROR(ENOSYS);
    return sink.succeeds([&] { sink.file.seek(offset); }) ? offset : AVERROR(EIO);
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

/// As the tone-mapped numbers are: sRGB's primaries, the power 1/2.2.
void declare_colours(AVCodecContext& encoder) {
    encoder.color_range = AVCOL_RANGE_MPEG;
    encoder.colorspace = AVCOL_SPC_BT709;
    encoder.color_primaries = AVCOL_PRI_BT709;
    encoder.color_trc = AVCOL_TRC_GAMMA22;
}

/// From grey or RGB of 8 bits; the same bits on any processor.
FfmpegPtr<SwsContext> new_scaler(const AVFrame& from, const AVFrame& to) {
    constexpr int kFlags =
        SWS_BICUBIC | SWS_ACCURATE_RND | SWS_FULL_CHR_H_INT | SWS_FULL_CHR_H_INP | SWS_BITEXACT;
    constexpr int kOne = 1 << 16;
    FfmpegPtr<SwsContext> scaler(sws_getContext(
        from.width, from.height, static_cast<AVPixelFormat>(from.format), to.width, to.height,
        static_cast<AVPixelFormat>(to.format), kFlags, nullptr, nullptr, nullptr));
    const int* const matrix = sws_getCoefficients(SWS_CS_ITU709);
    if (scaler) sws_setColorspaceDetails(scaler.get(), matrix, 1, matrix, 0, 0, kOne, kOne);
    return scaler;
}

}  // namespace

struct VideoWriter::Impl {
    std::string where;
    FrameShape shape;
    Sink sink;
    std::vector<std::uint8_t> pixels;  ///< as tone-mapped
    FfmpegPtr<AVIOContext> bytes;
    FfmpegPtr<AVFormatContext> muxer;
    FfmpegPtr<AVCodecContext> encoder;
    FfmpegPtr<AVPacket> packet;
    FfmpegPtr<AVFrame> padded;   ///< the pixels, and what makes them an even number
    FfmpegPtr<AVFrame> encoded;  ///< in Y'CbCr
    FfmpegPtr<SwsContext> scaler;
    AVStream* stream = nullptr;
    std::int64_t next_slot = 0;

    Impl(const std::filesystem::path& file, std::string_view named, FrameShape frame)
        : where(named), shape(frame), sink{OutputFile(file, where)}, pixels(frame.sites()) {}
    void open(const std::filesystem::path& file, double frames_per_second);
    void open_encoder(AVRational rate);
    void pad();
    void encode(const AVFrame* frame);
    /// \throws what the disk has thrown, else DeviceError, if `result` is an error.
    void check(int result, std::string_view what) const {
        if (sink.failure) std::rethrow_exception(sink.failure);
        if (result < 0)
            throw DeviceError(where, fmt::format("{}: {}", what, ffmpeg_reason(result)));
    }
};

void VideoWriter::Impl::open_encoder(AVRational rate) {
    const AVCodec* const codec = avcodec_find_encoder(AV_CODEC_ID_H264);
    if (codec == nullptr) throw DeviceError(where, "FFmpeg here has no encoder for H.264");
    encoder.reset(avcodec_alloc_context3(codec));
    if (!encoder) throw std::bad_alloc();
    // Even, and at least four columns: FFmpeg 5.1 converts narrower frames beyond their memory.
    encoder->width = std::max(shape.cols + shape.cols % 2, 4);
    encoder->height = shape.rows + shape.rows % 2;
    encoder->pix_fmt = AV_PIX_FMT_YUV420P;
    encoder->framerate = rate;
    encoder->time_base = av_inv_q(rate);
    encoder->thread_count = kThreads;
    declare_colours(*encoder);
    if ((muxer->oformat->flags & AVFMT_GLOBALHEADER) != 0)
        encoder->flags |= AV_CODEC_FLAG_GLOBAL_HEADER;
    AVDictionary* options = nullptr;
    av_dict_set(&options, "crf", kQuality, 0);
    const int result = avcodec_open2(encoder.get(), codec, &options);
    av_dict_free(&options);
    check(result, fmt::format("no video of {} x {} pixels at {} frames per second can be encoded",
                              shape.cols, shape.rows, av_q2d(rate)));
}

void VideoWriter::Impl::open(const std::filesystem::path& file, double frames_per_second) {
    constexpr int kMaxTermOfRate = 60'000;  // numerator, denominator
    constexpr const char* kCreate = "cannot be created";
    av_log_set_level(AV_LOG_QUIET);
    AVFormatContext* created = nullptr;
    check(avformat_alloc_output_context2(&created, nullptr, nullptr, file.c_str()), kCreate);
    muxer.reset(created);
    open_encoder(av_d2q(frames_per_second, kMaxTermOfRate));
    packet.reset(av_packet_alloc());
    padded = new_frame(shape.planes == 1 ? AV_PIX_FMT_GRAY8 : AV_PIX_FMT_RGB24, encoder->width,
                       encoder->height);
    encoded = new_frame(encoder->pix_fmt, encoder->width, encoder->height);
    if (packet && padded && encoded) scaler = new_scaler(*padded, *encoded);
    stream = avformat_new_stream(muxer.get(), nullptr);
    auto* const buffer = static_cast<unsigned char*>(av_malloc(kBufferBytes));
    if (buffer != nullptr)
        bytes.reset(avio_alloc_context(buffer, kBufferBytes, 1, &sink, nullptr, write_bytes, seek));
    if (!scaler || stream == nullptr || !bytes) throw std::bad_alloc();
    check(avcodec_parameters_from_context(stream->codecpar, encoder.get()), kCreate);
    stream->time_base = encoder->time_base;
    stream->avg_frame_rate = encoder->framerate;
    muxer->pb = bytes.get();
    muxer->flags |= AVFMT_FLAG_BITEXACT;  // neither time nor random numbers
    check(avformat_write_header(muxer.get(), nullptr), kCreate);
}

/// Repeats the last row and column.
void VideoWriter::Impl::pad() {
    const auto planes = static_cast<std::size_t>(shape.planes);
    const std::size_t row_bytes = static_cast<std::size_t>(shape.cols) * planes;
    for (int row = 0; row < padded->height; ++row) {
        const std::uint8_t* const from =
            pixels.data() + static_cast<std::size_t>(std::min(row, shape.rows - 1)) * row_bytes;
        std::uint8_t* to = padded->data[0] + static_cast<std::ptrdiff_t>(row) * padded->linesize[0];
        std::memcpy(to, from, row_bytes);
        to += row_bytes;
        for (int col = shape.cols; col < padded->width; ++col, to += planes)
            std::memcpy(to, from + row_bytes - planes, planes);
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
                         FrameShape shape, double frames_per_second)
    : impl_(std::make_unique<Impl>(file, where, shape)) {
    impl_->open(file, frames_per_second);
}

VideoWriter::~VideoWriter() = default;
VideoWriter::VideoWriter(VideoWriter&&) noexcept = default;
VideoWriter& VideoWriter::operator=(VideoWriter&&) noexcept = default;

void VideoWriter::write(std::span<const float> frame) {
    tone_map_frame(frame, impl_->shape, impl_->pixels);
    impl_->pad();
    const AVFrame& from = *impl_->padded;
    AVFrame& to = *impl_->encoded;
    impl_->check(av_frame_make_writable(&to), "a frame cannot be encoded");
    sws_scale(impl_->scaler.get(), from.data, from.linesize, 0, from.height, to.data, to.linesize);
    to.pts = impl_->next_slot++;
    impl_->encode(&to);
}

void VideoWriter::finish() {
    impl_->encode(nullptr);
    impl_->check(av_write_trailer(impl_->muxer.get()), "cannot be written");
    impl_->sink.file.close();
}

}  // namespace stipple
