#pragma once

#include <memory>
#include <string>

#include "io/lazy_function.h"

struct AVCodecContext;  // of FFmpeg's libraries
struct AVFormatContext;
struct AVFrame;
struct AVIOContext;
struct AVPacket;
struct SwsContext;

namespace stipple {

/// A function of FFmpeg's libraries. They bring 110 other libraries with them; so they are loaded
/// when the first function is requested, not at the start of the program. \throws DeviceError if
/// they cannot be loaded.
[[nodiscard]] void* ffmpeg_function(const char* name);

/// In a source: a function of FFmpeg.
#define STIPPLE_LAZY(name) STIPPLE_LAZY_FROM(ffmpeg_function, name)

/// Frees objects of FFmpeg.
struct FfmpegDeleter {
    void operator()(AVCodecContext* codec) const;
    void operator()(AVFormatContext* file) const;
    void operator()(AVFrame* frame) const;
    void operator()(AVIOContext* bytes) const;
    void operator()(AVPacket* packet) const;
    void operator()(SwsContext* scaler) const;
};
template <typename Type>
using FfmpegPtr = std::unique_ptr<Type, FfmpegDeleter>;

/// The meaning of an error code of FFmpeg.
[[nodiscard]] std::string ffmpeg_reason(int error);

}  // namespace stipple
