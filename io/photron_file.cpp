// Keys and their meaning: pyMRAW (docs/references.md).
#include "io/camera_file.h"

#include <fmt/format.h>
#include <tinyxml2.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cctype>
#include <cmath>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "core/error.h"
#include "core/light.h"
#include "core/text.h"
#include "io/footage_files.h"
#include "io/pixel_format.h"

namespace stipple {
namespace fs = std::filesystem;
namespace {

/// What is read of a header: its keys in .cih, and their places in the XML of .cihx.
struct Key {
    std::string_view name;
    std::array<const char*, 3> path;
};
constexpr Key kFormat{"File Format", {"imageFileInfo", "fileFormat"}};
constexpr Key kFrames{"Total Frame", {"frameInfo", "totalFrame"}};
constexpr Key kWidth{"Image Width", {"imageDataInfo", "resolution", "width"}};
constexpr Key kHeight{"Image Height", {"imageDataInfo", "resolution", "height"}};
constexpr Key kColour{"Color Type", {"imageDataInfo", "colorInfo", "type"}};
constexpr Key kStoredBits{"Color Bit", {"imageDataInfo", "colorInfo", "bit"}};
constexpr Key kDepth{"EffectiveBit Depth", {"imageDataInfo", "effectiveBit", "depth"}};
constexpr Key kSide{"EffectiveBit Side", {"imageDataInfo", "effectiveBit", "side"}};
constexpr Key kRate{"Record Rate(fps)", {"recordInfo", "recordRate"}};
constexpr Key kStep{"Save Step", {"frameInfo", "skipFrame"}};
/// In .cih seconds, as 1/800000; in .cihx the N of 1/N s.
constexpr Key kShutter{"Shutter Speed(s)", {"recordInfo", "shutterSpeed"}};
constexpr Key kCamera{"Camera Type", {"deviceInfo", "deviceName"}};
constexpr Key kShutterNs{"Shutter Type2(nsec)", {"recordInfo", "shutterSpeedNsec"}};
constexpr Key kProcessed{"Apply Image Proc", {"imageDataInfo", "applyImageProc"}};
constexpr Key kAutoExposure{"Auto Exposure", {"recordInfo", "autoExposure"}};
constexpr std::array kKeys{kAutoExposure, kFormat,     kFrames,    kWidth,     kHeight,
                           kColour,       kStoredBits, kDepth,     kSide,      kRate,
                           kStep,         kShutter,    kShutterNs, kProcessed, kCamera};

std::string_view trimmed(std::string_view text) {
    constexpr std::string_view kBlanks = " \t\r\n";
    const auto first = std::min(text.find_first_not_of(kBlanks), text.size());
    text.remove_prefix(first);
    return text.substr(0, text.find_last_not_of(kBlanks) + 1);
}

/// The values of a header by their names in .cih.
class Header {
  public:
    explicit Header(const fs::path& file);

    [[nodiscard]] const std::string& name() const { return name_; }
    [[nodiscard]] bool has(const Key& key) const { return values_.contains(key.name); }
    /// \throws InputError if it is missing.
    [[nodiscard]] std::string_view text(const Key& key) const;
    /// The same of a whole number above 0.
    [[nodiscard]] std::uint32_t count(const Key& key) const;
    /// Of "0.0001" or "1/10000"; nothing if it is no positive number or missing.
    [[nodiscard]] std::optional<double> number(const Key& key) const;
    /// Declared as the time of a shutter, in seconds; nothing if it is not.
    [[nodiscard]] std::optional<double> shutter_s() const;

  private:
    void read_lines(std::string_view text);
    void read_xml(std::string_view text);

    std::string name_;
    bool is_xml_ = false;
    std::map<std::string, std::string, std::less<>> values_;
};

Header::Header(const fs::path& file) : name_(file.string()) {
    constexpr std::uint64_t kMaxBytes = std::uint64_t{1} << 20U;
    RandomAccessFile bytes(file);
    if (bytes.size() > kMaxBytes) throw InputError(name_, "is too long for the header of a video");
    std::string text(bytes.size(), '\0');
    bytes.read(0, {reinterpret_cast<std::uint8_t*>(text.data()), text.size()});
    is_xml_ = lower_extension(file) != ".cih";
    is_xml_ ? read_xml(text) : read_lines(text);
}

/// "Key : value" each.
void Header::read_lines(std::string_view text) {
    while (!text.empty()) {
        const std::string_view line = text.substr(0, text.find('\n'));
        text.remove_prefix(std::min(text.size(), line.size() + 1));
        const auto colon = line.find(" : ");
        if (colon == std::string_view::npos) continue;
        values_.insert_or_assign(std::string(trimmed(line.substr(0, colon))),
                                 std::string(trimmed(line.substr(colon + 3))));
    }
}

/// Other bytes may come before and after the XML.
void Header::read_xml(std::string_view text) {
    constexpr std::string_view kEnd = "</cih>";
    const auto begin = std::min(text.find("<cih>"), text.size());
    const auto end = text.rfind(kEnd);
    tinyxml2::XMLDocument document;
    if (end == std::string_view::npos || end < begin ||
        document.Parse(text.data() + begin, end + kEnd.size() - begin) != tinyxml2::XML_SUCCESS)
        throw InputError(name_,
                         "holds no XML from <cih> to </cih>; it is damaged or none of a "
                         "Photron camera");
    for (const Key& key : kKeys) {
        const tinyxml2::XMLElement* element = document.RootElement();
        for (const char* const part : key.path)
            if (element != nullptr && part != nullptr) element = element->FirstChildElement(part);
        if (element != nullptr && element->GetText() != nullptr)
            values_.emplace(key.name, trimmed(element->GetText()));
    }
}

std::string_view Header::text(const Key& key) const {
    const auto found = values_.find(key.name);
    if (found == values_.end())
        throw InputError(name_, fmt::format("has no \"{}\"; it is damaged or none of a Photron "
                                            "camera",
                                            key.name));
    return found->second;
}

std::uint32_t Header::count(const Key& key) const {
    const std::string_view value = text(key);
    const auto number = parsed_number<std::uint32_t>(value);
    if (!number || *number == 0)
        throw InputError(name_,
                         fmt::format("\"{}\" is \"{}\", no number above 0", key.name, value));
    return *number;
}

std::optional<double> Header::number(const Key& key) const {
    const auto found = values_.find(key.name);
    if (found == values_.end()) return {};
    const std::string_view value = found->second;
    const auto slash = std::min(value.find('/'), value.size());
    const auto part = [](std::string_view text) { return parsed_number<double>(text).value_or(0); };
    const double numerator = part(value.substr(0, slash));
    const double result =
        slash == value.size() ? numerator : numerator / part(value.substr(slash + 1));
    return std::isfinite(result) && result > 0 ? std::optional(result) : std::nullopt;
}

std::optional<double> Header::shutter_s() const {
    const auto value = number(kShutter);
    return value && is_xml_ ? std::optional(1 / *value) : value;
}

bool same_letters(std::string_view a, std::string_view b) {
    return std::ranges::equal(a, b, [](char x, char y) { return (x | 32) == (y | 32); });
}

/// The file of the same name beside it that has one of the extensions.
fs::path beside(const fs::path& file, std::span<const char* const> extensions) {
    for (const char* const extension : extensions) {
        fs::path other = file;
        other.replace_extension(extension);
        std::error_code unknown;
        if (fs::exists(other, unknown)) return other;
    }
    throw InputError(file.string(),
                     fmt::format("needs the {} file of the same name beside it", extensions[0]));
}

/// Whether the bits that are used are the highest of a sample.
bool is_at_top(const Header& header) {
    const std::string_view side = header.text(kSide);
    if (same_letters(side, "higher")) return true;
    if (same_letters(side, "lower")) return false;
    throw InputError(header.name(),
                     fmt::format("\"{}\" is \"{}\", neither Lower nor Higher", kSide.name, side));
}

/// Whether the name of a camera has the -M of grey ones, as "FASTCAM SA-Z type 2100K-M-64GB".
bool is_grey_camera(std::string_view name) {
    for (auto at = name.find("-M"); at != name.npos; at = name.find("-M", at + 1)) {
        const bool ends = at + 2 == name.size();
        if (ends || std::isalpha(static_cast<unsigned char>(name[at + 2])) == 0) return true;
    }
    return false;
}

/// "Raw" is what the sensor gave: grey, or the mosaic of a filter array that no key names.
/// \throws InputError unless the pixels are grey.
void check_grey(const Header& header, std::uint32_t stored, std::uint32_t depth) {
    const std::string_view colour = header.has(kColour) ? header.text(kColour) : "Mono";
    const bool is_raw = same_letters(colour, "raw");
    const std::string_view camera = header.has(kCamera) ? header.text(kCamera) : "not named";
    if (same_letters(colour, "mono") || (is_raw && is_grey_camera(camera))) return;
    if (!is_raw)
        throw InputError(header.name(),
                         fmt::format("declares colour (\"{}\"); only grey is supported", colour));
    const bool in_words = depth >= 10 && depth < stored && depth % 2 == 0 && !is_at_top(header);
    const std::string bits = stored == 12 ? "12msb" : fmt::to_string(in_words ? depth : stored);
    const std::string size = fmt::format("{}x{}", header.count(kWidth), header.count(kHeight));
    throw InputError(
        header.name(),
        fmt::format("declares raw pixels of a camera that is not known to be grey ({}); give the "
                    ".mraw file with ",
                    camera) +
            Parameter{"raw", size + ":bayerrg" + bits} +
            " (or bayergr, bayergb, bayerbg, as its filter array begins), or " +
            Parameter{"raw", size + ":mono" + bits} + " if it is grey");
}

/// The format, and its highest number.
std::pair<PixelFormat, int> format_of(const Header& header) {
    const std::uint32_t stored = header.count(kStoredBits);
    const std::uint32_t depth = header.count(kDepth);
    if (!same_letters(header.text(kFormat), "mraw"))
        throw InputError(header.name(),
                         fmt::format("declares the format \"{}\"; only MRAW is supported",
                                     header.text(kFormat)));
    if (stored != 8 && stored != 12 && stored != 16)
        throw InputError(
            header.name(),
            fmt::format("declares {} bits per pixel; only 8, 12 and 16 are supported", stored));
    check_grey(header, stored, depth);
    PixelFormat format{.name = "MRAW"};
    format.bits_per_pixel = format.significant_bits = static_cast<int>(stored);
    format.packing = stored == 12 ? Packing::kMsbPacked : Packing::kBytes;
    const std::uint32_t used = std::min(stored, depth);
    return {format, ((1 << used) - 1) << (is_at_top(header) ? stored - used : 0)};
}

/// Rate and exposure. The frames of a file may be every N-th of the recording.
void read_times(const Header& header, SourceInfo& traits) {
    traits.frames_hz = header.number(kRate);
    const double step = header.number(kStep).value_or(1);
    if (traits.frames_hz && step > 1) {
        *traits.frames_hz /= step;
        traits.warnings.push_back(
            fmt::format("has one in {:.10g} of the {:.10g} frames per second recorded, so {:.10g} "
                        "per second; ",
                        step, *header.number(kRate), *traits.frames_hz) +
            Parameter{"frames_hz"} + " sets another rate");
    }
    constexpr double kSecondsPerNanosecond = 1e-9;
    constexpr double kMicrosecondsPerSecond = 1e6;
    constexpr double kRounding = 0.02;
    const auto shutter_s = header.shutter_s();
    const auto shutter_ns = header.number(kShutterNs);
    if (!shutter_s && !shutter_ns) return;
    const double exposure_s = shutter_ns ? *shutter_ns * kSecondsPerNanosecond : *shutter_s;
    traits.exposure_us = exposure_s * kMicrosecondsPerSecond;
    if (shutter_s && std::abs(*shutter_s - exposure_s) > kRounding * exposure_s)
        traits.warnings.push_back(fmt::format(
            "declares two exposures, {:.4g} us and {:.4g} us; the first, in nanoseconds, is taken",
            *traits.exposure_us, *shutter_s * kMicrosecondsPerSecond));
}

}  // namespace

bool is_photron_name(const fs::path& file) {
    const std::string extension = lower_extension(file);
    return extension == ".mraw" || extension == ".cihx" || extension == ".cih";
}

PhotronFiles photron_files(const fs::path& file) {
    constexpr std::array<const char*, 2> kFrameFiles{".mraw", ".MRAW"};
    constexpr std::array<const char*, 4> kHeaders{".cihx", ".cih", ".CIHX", ".CIH"};
    if (lower_extension(file) == ".mraw") return {beside(file, kHeaders), file};
    return {file, beside(file, kFrameFiles)};
}

RawVideo open_photron(const fs::path& file) {
    const PhotronFiles files = photron_files(file);
    const Header header(files.header);
    const auto [format, white_dn] = format_of(header);
    RawVideo video{
        .file = files.frames,
        .format = format,
        .shape = checked_shape(header.count(kHeight), header.count(kWidth), 1, header.name()),
        .slots = header.count(kFrames),
        .light_of_dn = light_table(format, 0, white_dn)};
    if (video.shape.cols * format.bits_per_pixel % 8 != 0)
        throw InputError(header.name(),
                         fmt::format("declares packed rows of {} pixels, which end within a byte; "
                                     "only whole bytes are supported",
                                     video.shape.cols));
    video.traits.bits = std::popcount(static_cast<unsigned>(white_dn));
    video.traits.white_dn = white_dn;
    read_times(header, video.traits);
    if (header.number(kProcessed))
        video.traits.warnings.emplace_back(
            "was saved with image processing, after which its numbers may not be linear light");
    if (header.has(kAutoExposure) && header.text(kAutoExposure) != "0" &&
        !same_letters(header.text(kAutoExposure), "off"))
        video.traits.warnings.emplace_back(
            "was recorded with automatic exposure: its frames may differ in exposure, for which "
            "their light is not corrected");
    return video;
}

}  // namespace stipple
