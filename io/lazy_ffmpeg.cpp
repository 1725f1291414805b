#include "io/lazy_ffmpeg.h"

#include <dlfcn.h>

#include <array>

#include "core/error.h"

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libavutil/macros.h>
#include <libswscale/swscale.h>
}

namespace stipple {
namespace {

STIPPLE_LAZY(av_frame_free);
STIPPLE_LAZY(av_freep);
STIPPLE_LAZY(av_packet_free);
STIPPLE_LAZY(av_strerror);
STIPPLE_LAZY(avcodec_free_context);
STIPPLE_LAZY(avformat_close_input);
STIPPLE_LAZY(avformat_free_context);
STIPPLE_LAZY(avio_context_free);
STIPPLE_LAZY(sws_freeContext);

/// Of the version whose headers were read. libavformat brings libavcodec and libavutil.
constexpr std::array kLibraries = {"libavformat.so." AV_STRINGIFY(LIBAVFORMAT_VERSION_MAJOR),
                                   "libswscale.so." AV_STRINGIFY(LIBSWSCALE_VERSION_MAJOR)};

std::array<void*, kLibraries.size()> load() {
    std::array<void*, kLibraries.size()> handles{};
    for (std::size_t i = 0; i < handles.size(); ++i) {
        handles[i] = dlopen(kLibraries[i], RTLD_NOW);
        if (handles[i] == nullptr)
            throw DeviceError(kLibraries[i],
                              std::string("cannot be loaded, but video needs it: ") + dlerror());
    }
    return handles;
}

}  // namespace

void* ffmpeg_function(const char* name) {
    static const auto handles = load();
    for (void* const handle : handles)
        if (void* const function = dlsym(handle, name)) return function;
    throw DeviceError(kLibraries[0], std::string("does not have ") + name);
}

void FfmpegDeleter::operator()(AVCodecContext* codec) const {
    avcodec_free_context(&codec);
}

void FfmpegDeleter::operator()(AVFormatContext* file) const {
    if (file->iformat != nullptr)
        avformat_close_input(&file);
    else
        avformat_free_context(file);
}

void FfmpegDeleter::operator()(AVFrame* frame) const {
    av_frame_free(&frame);
}

void FfmpegDeleter::operator()(AVIOContext* bytes) const {
    av_freep(&bytes->buffer);
    avio_context_free(&bytes);
}

void FfmpegDeleter::operator()(AVPacket* packet) const {
    av_packet_free(&packet);
}

void FfmpegDeleter::operator()(SwsContext* scaler) const {
    sws_freeContext(scaler);
}

std::string ffmpeg_reason(int error) {
    char text[AV_ERROR_MAX_STRING_SIZE] = {};
    av_strerror(error, text, sizeof(text));
    return text;
}

}  // namespace stipple
