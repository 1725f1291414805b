// Offsets and meanings: libavformat/cinedec.c of FFmpeg, pims/cine.py of PIMS, and pycine
// (docs/references.md). All numbers are little-endian.
#include "io/camera_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/light.h"
#include "io/pixel_format.h"

namespace stipple {
namespace {

static_assert(std::endian::native == std::endian::little);

/// A part of the file.
struct Block {
    std::vector<std::uint8_t> bytes;

    Block(RandomAccessFile& file, std::uint64_t offset, std::size_t length) : bytes(length) {
        file.read(offset, bytes);
    }
    template <typename Number>
    [[nodiscard]] Number at(std::size_t offset) const {
        Number number;
        std::memcpy(&number, bytes.data() + offset, sizeof(Number));
        return number;
    }
    [[nodiscard]] std::uint16_t u16(std::size_t offset) const { return at<std::uint16_t>(offset); }
    [[nodiscard]] std::uint32_t u32(std::size_t offset) const { return at<std::uint32_t>(offset); }
};

constexpr std::uint32_t kUnpacked = 0;  // kinds of biCompression
constexpr std::uint32_t kPacked10 = 256;
constexpr std::uint32_t kPacked12 = 1024;

constexpr std::uint16_t kTimeStamps = 1002;  // kinds of tagged blocks
constexpr std::uint16_t kExposures = 1003;

/// What the three headers say.
struct Cine {
    std::uint16_t compression = 0;
    std::uint32_t images = 0;
    std::uint32_t offsets_at = 0;
    std::uint32_t rows = 0;
    std::uint32_t cols = 0;
    std::uint16_t stored_bits = 0;
    std::uint32_t packing = kUnpacked;
    bool flipped = false;
    bool mirrored = false;
    std::int32_t turned_degrees = 0;
    std::uint32_t frames_hz = 0;
    double exposure_us = 0;
    double second_exposure_us = 0;  ///< of bright pixels (extreme dynamic range); 0: none
    std::uint32_t filter = 0;
    std::uint32_t real_bits = 0;
    std::int32_t black_dn = 0;
    std::int32_t white_dn = 0;  ///< 0: not declared
    std::uint64_t tags_at = 0;  ///< byte after SETUP, from which to offsets_at tagged blocks lie

    explicit Cine(RandomAccessFile& file);
    void read_setup(RandomAccessFile& file, std::uint64_t offset);
};

Cine::Cine(RandomAccessFile& file) {
    constexpr std::size_t kFileHeaderBytes = 44;
    constexpr std::size_t kBitmapHeaderBytes = 40;
    const Block header(file, 0, kFileHeaderBytes);
    if (header.bytes[0] != 'C' || header.bytes[1] != 'I')
        throw InputError(file.name(), "is not a .cine file: it does not begin with \"CI\"");
    if (header.u16(6) != 1)
        throw InputError(file.name(),
                         fmt::format("is a .cine file of version {}; 1 is read", header.u16(6)));
    compression = header.u16(4);
    images = header.u32(20);
    offsets_at = header.u32(32);
    const Block bitmap(file, header.u32(24), kBitmapHeaderBytes);
    cols = bitmap.u32(4);
    rows = bitmap.u32(8);
    stored_bits = bitmap.u16(14);
    packing = bitmap.u32(16);
    read_setup(file, header.u32(28));
}

/// The structure SETUP, which has grown with the versions of the camera's software.
void Cine::read_setup(RandomAccessFile& file, std::uint64_t offset) {
    constexpr std::size_t kMarkEnd = 144;
    constexpr std::size_t kMinBytes = 1572;  // with the exposure in ns
    constexpr std::size_t kLevelsEnd = 5740;
    const Block start(file, offset, kMarkEnd);
    const std::size_t length = start.u16(142);
    if (start.bytes[140] != 'S' || start.bytes[141] != 'T' || length < kMinBytes)
        throw InputError(fmt::format("{}: byte {}", file.name(), offset),
                         "has an unsupported camera SETUP block; save the file again with the "
                         "present software of Phantom cameras");
    const Block setup(file, offset, std::min(length, kLevelsEnd));
    tags_at = offset + length;
    mirrored = setup.u32(756) != 0;
    flipped = setup.u32(760) != 0;
    turned_degrees = setup.at<std::int32_t>(884);
    frames_hz = setup.u32(768);
    filter = setup.u32(808);
    real_bits = setup.u32(896);
    constexpr double kNanosecondsAMicrosecond = 1000;
    exposure_us = setup.u32(1568) / kNanosecondsAMicrosecond;
    if (setup.bytes.size() >= 1576) second_exposure_us = setup.u32(1572) / kNanosecondsAMicrosecond;
    if (length < kLevelsEnd) return;
    black_dn = setup.at<std::int32_t>(5732);
    white_dn = setup.at<std::int32_t>(5736);
}

PixelFormat format_of(const Cine& cine, const std::string& name) {
    constexpr std::uint16_t kRgb = 0;
    constexpr std::uint16_t kUninterpolated = 2;
    if (cine.compression != kRgb && cine.compression != kUninterpolated)
        throw InputError(name, fmt::format("is compressed (kind {}); save it as uncompressed .cine",
                                           cine.compression));
    PixelFormat format{.name = ".cine"};
    if (cine.packing == kPacked10 || cine.packing == kPacked12) {
        format.significant_bits = format.bits_per_pixel = cine.packing == kPacked10 ? 10 : 12;
        format.packing = Packing::kMsbPacked;
    } else if (cine.packing == kUnpacked && (cine.stored_bits == 8 || cine.stored_bits == 16)) {
        format.bits_per_pixel = cine.stored_bits;
        format.significant_bits = static_cast<int>(cine.real_bits);
        if (cine.stored_bits == 8) format.significant_bits = 8;
        if (cine.stored_bits == 16 && (cine.real_bits < 9 || cine.real_bits > 16))
            throw InputError(name, fmt::format("says that {} of 16 bits of a pixel are used; 9 to "
                                               "16 can be",
                                               cine.real_bits));
    } else {
        throw InputError(name, fmt::format("has {} bits per pixel in packing {}; grey and raw "
                                           "mosaics of 8 and 16 bits and packed in 10 and 12 are "
                                           "read, save it so",
                                           cine.stored_bits, cine.packing));
    }
    if (cine.compression == kRgb || cine.filter == 0) return format;
    constexpr std::uint32_t kGbrg = 3;
    constexpr std::uint32_t kRggb = 4;
    if (cine.filter != kGbrg && cine.filter != kRggb)
        throw InputError(name, fmt::format("has a colour filter array of kind {}; GBRG (3) and "
                                           "RGGB (4) are read",
                                           cine.filter));
    format.filter = cine.filter == kGbrg ? ColourFilter::kGbrg : ColourFilter::kRggb;
    return format;
}

/// Of light 0 and 1.
struct Levels {
    std::int32_t black_dn;
    std::int32_t white_dn;
};

Levels levels_of(const Cine& cine, const PixelFormat& format) {
    if (cine.packing == kPacked10) return {63, 1014};
    const std::int32_t full_scale = (1 << format.significant_bits) - 1;
    if (cine.black_dn >= 0 && cine.black_dn < cine.white_dn && cine.white_dn <= full_scale)
        return {cine.black_dn, cine.white_dn};
    return {0, full_scale};
}

/// Inverse of the opto-electronic transfer function of ITU-R BT.709.
std::vector<float> light_of_10_bits(const Levels& levels) {
    std::vector<float> light(65536);
    for (std::size_t dn = 0; dn < light.size(); ++dn) {
        const double value = (static_cast<double>(dn) - levels.black_dn) /
                             (static_cast<double>(levels.white_dn) - levels.black_dn);
        light[dn] =
            static_cast<float>(value <= 0      ? 0
                               : value < 0.081 ? value / 4.5
                                               : std::pow((value + 0.099) / 1.099, 1 / 0.45));
    }
    return light;
}

std::vector<float> light_of(const Cine& cine, const PixelFormat& format) {
    const Levels levels = levels_of(cine, format);
    return cine.packing == kPacked10 ? light_of_10_bits(levels)
                                     : light_table(format, levels.black_dn, levels.white_dn);
}

SourceInfo traits_of(const Cine& cine, const PixelFormat& format) {
    const Levels levels = levels_of(cine, format);
    SourceInfo traits{.filter = format.filter,
                      .bits = format.significant_bits,
                      .black_dn = levels.black_dn,
                      .white_dn = levels.white_dn,
                      .curve = cine.packing == kPacked10 ? "bt709" : "linear"};
    if (cine.frames_hz > 0) traits.frames_hz = cine.frames_hz;
    if (cine.exposure_us > 0) traits.exposure_us = cine.exposure_us;
    return traits;
}

/// Warnings of what is declared and not applied.
void warn_of_setup(const Cine& cine, SourceInfo& traits) {
    if (cine.second_exposure_us > 0 && cine.second_exposure_us < cine.exposure_us)
        traits.warnings.push_back(
            fmt::format("bright pixels were exposed for {:.4g} of {:.4g} us (extreme dynamic "
                        "range), so its numbers are not linear light",
                        cine.second_exposure_us, cine.exposure_us));
    if (cine.mirrored || cine.turned_degrees != 0)
        traits.warnings.push_back(fmt::format("is to be shown {}; its frames are read as stored",
                                              cine.mirrored ? "mirrored" : "turned"));
}

constexpr double kSecondsATick = 1.0 / (1ULL << 32U);  // of time stamps and exposures

/// The numbers of the tagged block of this kind, one a frame; empty if there is none. Blocks begin
/// with their length and kind.
template <typename Number>
std::vector<Number> numbers_of_frames(RandomAccessFile& file, const Cine& cine, std::uint16_t kind,
                                      SourceInfo& traits) {
    constexpr std::uint64_t kHeadBytes = 8;
    constexpr int kMaxBlocks = 64;
    std::uint64_t offset = cine.tags_at;
    for (int i = 0; i < kMaxBlocks && offset + kHeadBytes <= cine.offsets_at; ++i) {
        const Block head(file, offset, kHeadBytes);
        const std::uint64_t length = head.u32(0);
        if (length < kHeadBytes || length > cine.offsets_at - offset) break;
        const std::uint64_t count = (length - kHeadBytes) / sizeof(Number);
        if (head.u16(4) == kind && count != cine.images) {
            traits.warnings.push_back(fmt::format(
                "holds times of {} frames in place of {}; they are left out", count, cine.images));
            break;
        }
        if (head.u16(4) == kind) {
            std::vector<Number> numbers(count);
            file.read(offset + kHeadBytes,
                      {reinterpret_cast<std::uint8_t*>(numbers.data()), count * sizeof(Number)});
            return numbers;
        }
        offset += length;
    }
    return {};
}

double seconds(std::uint64_t ticks) {
    return static_cast<double>(static_cast<std::int64_t>(ticks)) * kSecondsATick;
}

/// Of a file saved with decimation, SETUP has the rate of the recording: the time stamps decide.
/// \returns the times of frames in frame periods if they are unequal.
std::vector<double> read_time_stamps(const std::vector<std::uint64_t>& stamps, SourceInfo& traits) {
    constexpr double kStampRoundingS = 1e-6;
    constexpr double kSameRate = 0.01;
    if (stamps.size() < 2) return {};
    std::vector<double> periods_s;
    for (std::size_t i = 1; i < stamps.size(); ++i)
        periods_s.push_back(seconds(stamps[i] - stamps[i - 1]));
    const auto [min_s, max_s] = std::ranges::minmax(periods_s);
    const auto middle = periods_s.begin() + std::ssize(periods_s) / 2;
    std::ranges::nth_element(periods_s, middle);
    const bool equal = max_s - min_s <= std::max(2 * kStampRoundingS, min_s / 2);
    const auto steps = static_cast<double>(periods_s.size());
    const double period_s = equal ? seconds(stamps.back() - stamps.front()) / steps : *middle;
    if (!(min_s > 0)) {
        traits.warnings.emplace_back("its time stamps do not increase; they are left out");
        return {};
    }
    if (!equal) traits.unequal_times = fmt::format("{:.4g} to {:.4g} s apart", min_s, max_s);
    const double rounding = kSameRate + kStampRoundingS / (equal ? steps * period_s : period_s);
    const double stamped_hz = 1 / period_s;
    const bool same = traits.frames_hz && std::abs(stamped_hz / *traits.frames_hz - 1) <= rounding;
    if (traits.frames_hz && !same)
        traits.warnings.push_back(
            fmt::format(
                "declares {:.10g} frames per second, but its time stamps are {:.4g} s apart; "
                "{:.5g} per second are taken; ",
                *traits.frames_hz, period_s, stamped_hz) +
            Parameter{"frames_hz"} + " sets another rate");
    if (!same) traits.frames_hz = stamped_hz;
    std::vector<double> times;
    for (const std::uint64_t stamp : stamps)
        if (!equal) times.push_back(seconds(stamp - stamps[0]) * *traits.frames_hz);
    return times;
}

void read_exposures(const std::vector<std::uint32_t>& exposures, SourceInfo& traits) {
    constexpr double kSameExposure = 0.01;
    constexpr double kMicrosecondsATick = kSecondsATick * 1e6;
    if (exposures.empty()) return;
    const auto [shortest, longest] = std::ranges::minmax(exposures);
    const double min_us = shortest * kMicrosecondsATick;
    const double max_us = longest * kMicrosecondsATick;
    if (max_us - min_us > kSameExposure * max_us)
        traits.warnings.push_back(fmt::format(
            "its frames were exposed for {:.4g} to {:.4g} us, for which their light is not "
            "corrected",
            min_us, max_us));
}

}  // namespace

RawVideo open_cine(const std::filesystem::path& path) {
    RandomAccessFile file(path);
    const Cine cine(file);
    const PixelFormat format = format_of(cine, file.name());
    RawVideo video{.file = path,
                   .format = format,
                   .shape = checked_shape(cine.rows, cine.cols, 1, file.name()),
                   .slots = cine.images,
                   .annotated = true,
                   .bottom_up = cine.flipped == (cine.packing != kUnpacked),
                   .light_of_dn = light_of(cine, format),
                   .traits = traits_of(cine, format)};
    if (cine.images == 0) throw InputError(file.name(), "holds no frame");
    if (cine.images > file.size() / sizeof(std::uint64_t))
        throw InputError(file.name(), fmt::format("has {} bytes, but announces {} frames; it is "
                                                  "damaged or cut short",
                                                  file.size(), cine.images));
    if (static_cast<int>(cine.cols) * format.bits_per_pixel % 8 != 0)
        throw InputError(file.name(), fmt::format("packs rows of {} pixels, which end within a "
                                                  "byte; they are not read",
                                                  cine.cols));
    video.offsets.resize(cine.images);
    file.read(cine.offsets_at, {reinterpret_cast<std::uint8_t*>(video.offsets.data()),
                                video.offsets.size() * sizeof(std::uint64_t)});
    SourceInfo& traits = video.traits;
    warn_of_setup(cine, traits);
    video.times =
        read_time_stamps(numbers_of_frames<std::uint64_t>(file, cine, kTimeStamps, traits), traits);
    read_exposures(numbers_of_frames<std::uint32_t>(file, cine, kExposures, traits), traits);
    return video;
}

}  // namespace stipple
