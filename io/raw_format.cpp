#include "io/raw_format.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/light.h"
#include "core/parsed_number.h"
#include "io/pixel_unpack.h"

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
                     fmt::format("\"{}\" is no pixel format that is read; give one as mono8, "
                                 "mono16, mono12p, mono12packed, mono12msb, bayerrg12p or "
                                 "rgb8 (docs/footage.md)",
                                 name));
}

void set_key(RawFormat& raw, std::string_view key, std::string_view value) {
    const std::string_view where = raw.text;
    const double full_scale = (1 << raw.format.significant_bits) - 1;
    if (key == "offset") {
        if (const auto offset = parsed_number<std::uint64_t>(value)) {
            raw.offset = *offset;
            return;
        }
        throw InputError(where, fmt::format("offset={}: give a number of bytes", value));
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
        throw InputError(where,
                         fmt::format("\"{}\" is no key; there are offset=BYTES, black=DN and "
                                     "hz=RATE",
                                     key));
    }
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
        throw InputError(text, "give columns x rows and a pixel format, such as 640x480:mono12p");
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
        .light_of_dn = light_table(raw.format, raw.black_dn, full_scale),
        .traits = {.filter = raw.format.filter,
                   .frames_hz = raw.frames_hz,
                   .sample_format = std::string(raw.format.name),
                   .bits = raw.format.significant_bits,
                   .black_dn = raw.black_dn,
                   .white_dn = full_scale}};
    const FileBytes bytes(file);
    const std::uint64_t rest = bytes.size() - std::min(raw.offset, bytes.size());
    video.slots = rest / video.frame_bytes();
    if (video.slots == 0 || rest % video.frame_bytes() != 0)
        throw InputError(
            bytes.name(),
            fmt::format("has {} bytes{}, which are {:.6g} frames of {} x {} {} ({} bytes each); "
                        "check size, pixel format and offset of --raw",
                        bytes.size(),
                        raw.offset > 0 ? fmt::format(", {} from byte {} on", rest, raw.offset) : "",
                        static_cast<double>(rest) / static_cast<double>(video.frame_bytes()),
                        raw.cols, raw.rows, raw.format.name, video.frame_bytes()));
    return video;
}

}  // namespace stipple
