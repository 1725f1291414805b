#pragma once

#include <memory>
#include <string>

struct AVCodecContext;  // of FFmpeg's libraries
struct AVFormatContext;
struct AVFrame;
struct AVIOContext;
struct AVPacket;
struct SwsContext;

namespace stipple {

/// A function of FFmpeg's libraries. They bring 110 others with them, so they are no part of the
/// start of a program but are loaded when the first function is asked for.
/// \throws DeviceError if they cannot be loaded.
[[nodiscard]] void* ffmpeg_function(const char* name);

/// In a source: the function of FFmpeg's that has this name, in place of the one that would be
/// linked. An object that converts to the function is called as the function is.
// NOLINTBEGIN(bugprone-macro-parentheses): it is a name, no value
#define STIPPLE_LATE(name)                                                                         \
    const struct {                                                                                 \
        using Function = decltype(::name);                                                         \
        operator Function*() const { return reinterpret_cast<Function*>(ffmpeg_function(#name)); } \
    } name {                                                                                       \
    }
// NOLINTEND(bugprone-macro-parentheses)

/// Ends what FFmpeg has made.
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

/// What an error code of FFmpeg's means.
[[nodiscard]] std::string ffmpeg_reason(int error);

}  // namespace stipple
