#include "io/raw_format.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/light.h"
#include "core/text.h"
#include "io/pixel_format.h"

namespace stipple {
namespace {

/// Takes what stands before the next `separator`, or all.
std::string_view take_until(std::string_view& text, char separator) {
    const std::string_view part = text.substr(0, text.find(separator));
    text.remove_prefix(std::min(text.size(), part.size() + 1));
    return part;
}

bool same_letters(std::string_view a, std::string_view b) {
    return std::ranges::equal(a, b, [](char x, char y) {
        const auto lower = [](char c) { return c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c; };
        return lower(x) == lower(y);
    });
}

PixelFormat format_named(std::string_view name, std::string_view where) {
    constexpr std::string_view kMsb = "msb";
    const bool is_msb =
        name.size() > kMsb.size() && same_letters(name.substr(name.size() - kMsb.size()), kMsb);
    const std::string wanted =
        is_msb ? std::string(name.substr(0, name.size() - kMsb.size())) + "p" : std::string(name);
    for (const PixelFormat& known : pixel_formats()) {
        if (!same_letters(known.name, wanted)) continue;
        PixelFormat format = known;
        if (is_msb) format.packing = Packing::kMsbPacked;
        return format;
    }
    throw InputError(where,
                     fmt::format("\"{}\" is not a supported pixel format; give one as mono8, "
                                 "mono16, mono12p, mono12packed, mono12msb, bayerrg12p or "
                                 "rgb8 (docs/footage.md)",
                                 name));
}

std::uint64_t frame_bytes(const RawFormat& raw) {
    return raw.format.row_bytes(static_cast<int>(raw.cols)) * raw.rows;
}

void set_key(RawFormat& raw, std::string_view key, std::string_view value) {
    const std::string_view where = raw.text;
    const double full_scale = (1 << raw.format.significant_bits) - 1;
    const auto whole = [&](std::uint64_t min, std::string_view what) {
        const auto number = parsed_number<std::uint64_t>(value);
        if (number && *number >= min) return *number;
        throw InputError(where, fmt::format("{}={}: give a number of {}", key, value, what));
    };
    if (key == "offset") {
        raw.offset = whole(0, "bytes");
        return;
    }
    if (key == "stride") {
        const std::uint64_t frame = frame_bytes(raw);
        raw.stride = whole(frame, fmt::format("bytes, at least the {} of a frame", frame));
        return;
    }
    if (key == "frames") {
        raw.frames = whole(1, "frames");
        return;
    }
    const double number = parsed_number<double>(value).value_or(NAN);
    if (key == "black") {
        if (!(number >= 0 && number < full_scale))
            throw InputError(
                where, fmt::format("black={}: give a DN from 0 to below {}", value, full_scale));
        raw.black_dn = number;
    } else if (key == "hz") {
        if (!(number > 0 && std::isfinite(number)))
            throw InputError(where, fmt::format("hz={}: give frames per second", value));
        raw.frames_hz = number;
    } else {
        throw InputError(
            where, fmt::format("\"{}\" is an unknown key; there are offset=BYTES, stride=BYTES, "
                               "frames=N, black=DN and hz=RATE",
                               key));
    }
}

/// Keys by which the `bytes` of a file are `fitting` frames and a rest, or frames with gaps.
std::string remedies(const RawFormat& raw, std::uint64_t bytes, std::uint64_t stride,
                     std::uint64_t fitting) {
    if (fitting == 0) return {};
    const std::uint64_t used = (fitting - 1) * stride + frame_bytes(raw);
    std::string text =
        fmt::format(", or add frames={}, which leaves {} bytes at the end", fitting, bytes - used);
    constexpr std::uint64_t kMaxTrials = 1U << 20U;
    const std::uint64_t least = fitting - std::min(fitting - 1, kMaxTrials);
    for (std::uint64_t frames = fitting; frames > least && !raw.stride; --frames)
        if (bytes % frames == 0)
            return text +
                   fmt::format(", or stride={}, which makes {} frames", bytes / frames, frames);
    return text;
}

/// Number of frames in a file of `size` bytes. \throws InputError as open_raw_file.
std::uint64_t count_frames(const RawFormat& raw, std::uint64_t size, const std::string& name) {
    const std::uint64_t frame = frame_bytes(raw), stride = raw.stride.value_or(frame);
    const std::uint64_t bytes = size - std::min(raw.offset, size);
    const std::uint64_t fitting = bytes < frame ? 0 : (bytes - frame) / stride + 1;
    const std::string from =
        raw.offset > 0 ? fmt::format(", {} from byte {} on", bytes, raw.offset) : "";
    if (raw.frames.value_or(0) > fitting)
        throw InputError(name, fmt::format("has {} bytes{}, which is room for {} of frames={} ({} "
                                           "bytes each)",
                                           size, from, fitting, *raw.frames, frame));
    if (raw.frames) return *raw.frames;
    const std::uint64_t rest = bytes % stride;
    if (fitting > 0 && (rest == 0 || rest == frame)) return fitting;
    throw InputError(
        name,
        fmt::format("has {} bytes{}, which are {:.6g} frames of {} x {} {} ({} bytes each{}); "
                    "check size, pixel format and offset of ",
                    size, from, static_cast<double>(bytes) / static_cast<double>(stride), raw.cols,
                    raw.rows, raw.format.name, frame,
                    raw.stride ? fmt::format(", stride {}", stride) : "") +
            Parameter{"raw"} + remedies(raw, bytes, stride, fitting));
}

}  // namespace

RawFormat parse_raw_format(std::string_view text) {
    RawFormat raw;
    raw.text = text;
    std::string_view rest = text;
    std::string_view size = take_until(rest, ':');
    const auto cols = parsed_number<std::uint64_t>(take_until(size, 'x'));
    const auto rows = parsed_number<std::uint64_t>(size);
    if (!cols || !rows || rest.empty())
        throw InputError(text, "give width x height and a pixel format, such as 640x480:mono12p");
    raw.cols = *cols;
    raw.rows = *rows;
    raw.format = format_named(take_until(rest, ':'), text);
    static_cast<void>(
        checked_shape(raw.rows, raw.cols, static_cast<std::uint64_t>(raw.format.planes), text));
    while (!rest.empty()) {
        std::string_view value = take_until(rest, ':');
        const std::string_view key = take_until(value, '=');
        set_key(raw, key, value);
    }
    return raw;
}

RawVideo open_raw_file(const std::filesystem::path& file, const RawFormat& raw) {
    const double full_scale = (1 << raw.format.significant_bits) - 1;
    RawVideo video{
        .file = file,
        .format = raw.format,
        .shape = checked_shape(raw.rows, raw.cols, static_cast<std::uint64_t>(raw.format.planes),
                               file.string()),
        .first_offset = raw.offset,
        .stride = raw.stride.value_or(0),
        .light_of_dn = light_table(raw.format, raw.black_dn, full_scale),
        .traits = {.filter = raw.format.filter,
                   .frames_hz = raw.frames_hz,
                   .sample_format = std::string(raw.format.name),
                   .bits = raw.format.significant_bits,
                   .black_dn = raw.black_dn,
                   .white_dn = full_scale}};
    const RandomAccessFile bytes(file);
    video.slots = count_frames(raw, bytes.size(), bytes.name());
    return video;
}

}  // namespace stipple
