#pragma once

/// A sample stream to high-speed HDR video (docs/decoder.md):
///
///     stipple::DecodeSession session(
///         "clip.stipple",
///         stipple::read_decode_setup("fast", stipple::Config({"rounds=2"}, "decoder")));
///     stipple::FrameWriter video("decoded.npy", session.shape(), {.force = true});
///     session.run([&](std::int64_t slot, std::span<const float> light) {
///         video.write(light);
///         return slot + 1 < 60;  // false ends the decoding
///     });
///     video.finish();
///
/// `decode` does the same of a StreamReader, with DecodeOptions as C++ types; decode_windows shares
/// the work between processes (docs/scaling.md).
#include "core/config.h"
#include "decoder/decode_options.h"
#include "decoder/reconstruct.h"
#include "session/decode_session.h"
#include "session/video_shards.h"
#include "stipple/stream.h"
#include "stipple/video.h"
