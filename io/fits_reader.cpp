#include "io/fits_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <concepts>
#include <cstring>
#include <limits>
#include <map>
#include <string_view>

#include "core/error.h"
#include "core/light.h"
#include "core/text.h"
#include "io/footage_files.h"

namespace stipple {
namespace {

constexpr std::size_t kBlockBytes = 2880;
constexpr std::size_t kCardBytes = 80;

std::string_view trimmed(std::string_view text) {
    text.remove_prefix(std::min(text.find_first_not_of(' '), text.size()));
    return text.substr(0, text.find_last_not_of(' ') + 1);
}

/// The value of a card, "KEYWORD = value / comment", without quotes.
std::string value_of(std::string_view card) {
    std::string_view text = trimmed(card.substr(std::string_view("KEYWORD = ").size()));
    if (text.starts_with('\'')) {
        text.remove_prefix(1);
        return std::string(trimmed(text.substr(0, text.find('\''))));
    }
    return std::string(trimmed(text.substr(0, text.find('/'))));
}

/// The header of the primary array or of an extension, which is read block by block.
class Header {
  public:
    Header(RandomAccessFile& file, std::uint64_t begin);

    /// Offset of the array.
    [[nodiscard]] std::uint64_t end() const { return end_; }
    [[nodiscard]] bool is_primary() const { return is_primary_; }
    [[nodiscard]] std::string text(std::string_view key) const {
        const auto found = values_.find(key);
        return found == values_.end() ? "" : found->second;
    }
    /// In microseconds, of EXPTIME or EXPOSURE (seconds); nothing if it is no positive number.
    [[nodiscard]] std::optional<double> exposure_us() const;
    /// \throws InputError if it is there and no number.
    [[nodiscard]] std::optional<double> number(std::string_view key) const;
    /// \throws InputError unless it is a whole number from `min` to `max`.
    [[nodiscard]] std::int64_t count(std::string_view key, std::int64_t min,
                                     std::int64_t max) const;
    [[nodiscard]] std::int64_t axes() const { return count("NAXIS", 0, 999); }
    /// Of the array; nothing if these are more than `max`. \throws InputError as `count`.
    [[nodiscard]] std::optional<std::uint64_t> data_bytes(std::uint64_t max) const;

  private:
    const std::string& name_;
    std::uint64_t end_;
    bool is_primary_;
    std::map<std::string, std::string, std::less<>> values_;
};

Header::Header(RandomAccessFile& file, std::uint64_t begin)
    : name_(file.name()), end_(begin), is_primary_(begin == 0) {
    constexpr std::uint64_t kMaxBlocks = 1000;
    std::vector<std::uint8_t> block(kBlockBytes);
    while (true) {
        if (end_ - begin == kMaxBlocks * kBlockBytes)
            throw InputError(name_, "has a header without an end");
        file.read(end_, block);
        end_ += kBlockBytes;
        const std::string_view cards(reinterpret_cast<const char*>(block.data()), block.size());
        if (end_ == kBlockBytes && !cards.starts_with("SIMPLE  ="))
            throw InputError(name_, "is not a FITS file: it does not begin with SIMPLE");
        for (std::size_t at = 0; at < cards.size(); at += kCardBytes) {
            const std::string_view card = cards.substr(at, kCardBytes);
            const std::string_view key = trimmed(card.substr(0, 8));
            if (key == "END") return;
            if (card.substr(8, 2) == "= ") values_.emplace(key, value_of(card));
        }
    }
}

/// Nothing if it is none.
std::optional<double> finite_number(std::string text) {
    std::ranges::replace(text, 'D', 'E');  // Fortran's exponent
    const auto number =
        parsed_number<double>(std::string_view(text).substr(text.starts_with('+') ? 1 : 0));
    return number && std::isfinite(*number) ? number : std::nullopt;
}

std::optional<double> Header::number(std::string_view key) const {
    const std::string value = text(key);
    if (value.empty()) return {};
    if (const auto number = finite_number(value)) return number;
    throw InputError(name_, fmt::format("{} is \"{}\", no number", key, value));
}

std::optional<double> Header::exposure_us() const {
    constexpr double kMicrosecondsPerSecond = 1e6;
    for (const char* key : {"EXPTIME", "EXPOSURE"}) {
        const double us = finite_number(text(key)).value_or(0) * kMicrosecondsPerSecond;
        if (us > 0 && std::isfinite(us)) return us;
    }
    return {};
}

std::int64_t Header::count(std::string_view key, std::int64_t min, std::int64_t max) const {
    const double value = number(key).value_or(-1e300);
    if (value >= static_cast<double>(min) && value <= static_cast<double>(max) &&
        value == std::floor(value))
        return static_cast<std::int64_t>(value);
    throw InputError(name_, fmt::format("{} is \"{}\", not {} to {}", key, text(key), min, max));
}

std::optional<std::uint64_t> Header::data_bytes(std::uint64_t max) const {
    constexpr std::int64_t kMax = std::numeric_limits<int>::max();
    const auto count_or = [&](const char* key, std::int64_t absent) {
        return static_cast<std::uint64_t>(text(key).empty() ? absent : count(key, 0, kMax));
    };
    const std::int64_t axes = this->axes();
    std::uint64_t bytes = axes == 0 ? 0 : 1;
    const auto multiply = [&](std::uint64_t factor) {
        if (factor > 0 && bytes > max / factor) return false;
        bytes *= factor;
        return true;
    };
    for (std::int64_t axis = 1; axis <= axes; ++axis)
        if (!multiply(static_cast<std::uint64_t>(count(fmt::format("NAXIS{}", axis), 0, kMax))))
            return {};
    bytes += count_or("PCOUNT", 0);
    const auto number_bytes = static_cast<std::uint64_t>(std::abs(count("BITPIX", -64, 64)) / 8);
    return multiply(count_or("GCOUNT", 1)) && multiply(number_bytes) ? std::optional(bytes)
                                                                     : std::nullopt;
}

/// In whole blocks.
std::uint64_t padded(std::uint64_t bytes) {
    return (bytes + kBlockBytes - 1) / kBlockBytes * kBlockBytes;
}

/// Whether an extension begins there, of which `start` is the beginning of the header.
bool begins_extension(RandomAccessFile& file, std::uint64_t at,
                      std::string_view start = "XTENSION") {
    std::vector<std::uint8_t> found(start.size());
    if (at > file.size() || file.size() - at < kBlockBytes) return false;
    file.read(at, found);
    return std::ranges::equal(found, start);
}

/// The header of the primary array; where that is empty, of the image extension of 2 axes or more.
/// \throws InputError if there are several of these, or only a compressed one.
Header image_header(RandomAccessFile& file, const Header& primary) {
    if (primary.axes() > 0) return primary;
    std::optional<Header> image;
    std::vector<std::string> names;
    bool compressed = false;
    std::uint64_t at = primary.end();
    for (int extension = 1; begins_extension(file, at); ++extension) {
        const Header header(file, at);
        const std::string kind = header.text("XTENSION");
        const auto bytes = header.data_bytes(file.size());
        compressed |= kind == "BINTABLE" && header.text("ZIMAGE") == "T";
        if (kind == "IMAGE" && header.axes() > 1 && bytes != 0) {
            if (!image) image.emplace(header);
            names.push_back(fmt::format("{} \"{}\"", extension, header.text("EXTNAME")));
        }
        if (!bytes) break;
        at = header.end() + padded(*bytes);
    }
    if (names.size() > 1) {
        constexpr std::size_t kMaxNames = 8;
        const char* more = names.size() > kMaxNames ? ", ..." : "";
        names.resize(std::min(names.size(), kMaxNames));
        throw InputError(file.name(),
                         fmt::format("holds images in its extensions {}{}; write one to a file of "
                                     "its own, as with \"fitscopy '{}[N]' one.fits\"",
                                     joined(names), more, file.name()));
    }
    if (!image && compressed)
        throw InputError(file.name(), "holds a compressed image; unpack it with funpack");
    return image ? *image : primary;
}

/// \throws InputError unless the third axis is time, or not named.
void add_frames(const Header& header, int frames, const std::string& name, SourceInfo& traits) {
    constexpr std::array<std::string_view, 9> kTimes{"TIME", "UTC", "TAI", "TT", "TDB",
                                                     "TCG",  "TCB", "UT1", "GPS"};
    const std::string axis = header.text("CTYPE3");
    const std::string unit = header.text("CUNIT3");
    const double step_s = finite_number(header.text("CDELT3")).value_or(0);
    if (frames == 1) return;
    if (axis.empty() && frames == 3)
        traits.warnings.emplace_back(
            "has 3 frames; if they are red, green and blue, convert it to PNG or TIFF");
    if (axis.empty()) return;
    if (std::ranges::find(kTimes, axis) == kTimes.end())
        throw InputError(name,
                         fmt::format("its third axis is \"{}\", not time; write each plane to "
                                     "a file of its own",
                                     axis));
    if ((unit.empty() || unit == "s") && step_s > 0) traits.frames_hz = 1 / step_s;
}

/// What else the header declares of its numbers.
void add_numbers(const Header& header, SourceInfo& traits) {
    traits.sample_format = fmt::format("BITPIX {}", header.text("BITPIX"));
    if (const std::string unit = header.text("BUNIT"); !unit.empty())
        traits.sample_format += ", " + unit;
    const double pedestal = finite_number(header.text("PEDESTAL")).value_or(0);
    if (pedestal != 0)
        traits.warnings.push_back(fmt::format(
            "declares a pedestal of {:g}, which is not subtracted from its numbers", pedestal));
}

/// The number of big-endian bytes.
template <typename Stored, std::unsigned_integral Word>
double number_at(const std::uint8_t* bytes) {
    static_assert(sizeof(Stored) == sizeof(Word));
    Word word = 0;
    for (std::size_t i = 0; i < sizeof(Word); ++i)
        word = static_cast<Word>(std::uint64_t{word} << 8U | bytes[i]);
    return static_cast<double>(std::bit_cast<Stored>(word));
}

using NumberAt = double (*)(const std::uint8_t*);

/// Null of a kind that there is not.
NumberAt number_of_kind(int bits) {
    switch (bits) {
        case 8:
            return number_at<std::uint8_t, std::uint8_t>;
        case 16:
            return number_at<std::int16_t, std::uint16_t>;
        case 32:
            return number_at<std::int32_t, std::uint32_t>;
        case 64:
            return number_at<std::int64_t, std::uint64_t>;
        case -32:
            return number_at<float, std::uint32_t>;
        case -64:
            return number_at<double, std::uint64_t>;
        default:
            return nullptr;
    }
}

/// The number that is light 1.0.
double full_scale(int bits, double zero, double scale) {
    if (scale != 1) return 1;
    if (bits == 8 && zero == 0) return std::numeric_limits<std::uint8_t>::max();
    if (bits == 16 && zero == 0) return std::numeric_limits<std::int16_t>::max();
    if (bits == 16 && zero == 32768) return std::numeric_limits<std::uint16_t>::max();
    return 1;
}

}  // namespace

bool is_fits_name(const std::filesystem::path& file) {
    const std::string extension = lower_extension(file);
    return extension == ".fits" || extension == ".fit" || extension == ".fts";
}

FitsReader::FitsReader(const std::filesystem::path& path) : file_(path) {
    constexpr std::int64_t kMax = std::numeric_limits<int>::max();
    const Header primary(file_, 0), header = image_header(file_, primary);
    const auto inherited = [&](const char* key) {
        const std::string value = header.text(key);
        return value.empty() ? primary.text(key) : value;
    };
    bits_ = static_cast<int>(header.count("BITPIX", -64, 64));
    if (number_of_kind(bits_) == nullptr)
        throw InputError(file_.name(), fmt::format("BITPIX is {}, which there is not", bits_));
    const std::int64_t axes = header.axes();
    if (axes != 2 && axes != 3)
        throw InputError(
            file_.name(),
            fmt::format("its {} has {} axes; one of 2 or 3 is read{}",
                        header.is_primary() ? "primary array" : "image extension", axes,
                        axes == 0 ? ", or an image extension, of which it has none" : ""));
    shape_ =
        checked_shape(static_cast<std::uint64_t>(header.count("NAXIS2", 1, kMax)),
                      static_cast<std::uint64_t>(header.count("NAXIS1", 1, kMax)), 1, file_.name());
    slots_ = axes == 2 ? 1 : static_cast<int>(header.count("NAXIS3", 1, kMax));
    if (!inherited("BAYERPAT").empty())
        throw InputError(file_.name(),
                         "is a mosaic (BAYERPAT), whose first row FITS does not fix; "
                         "convert it to DNG");
    data_offset_ = header.end();
    const std::uint64_t frame_bytes =
        shape_.pixels() * static_cast<std::uint64_t>(std::abs(bits_) / 8);
    if (static_cast<std::uint64_t>(slots_) * frame_bytes > file_.size() - data_offset_)
        throw InputError(file_.name(),
                         fmt::format("has {} bytes, but {} frames of {} bytes from "
                                     "byte {} on are announced; it is damaged or cut "
                                     "short",
                                     file_.size(), slots_, frame_bytes, data_offset_));
    bytes_.resize(frame_bytes);
    zero_ = header.number("BZERO").value_or(0);
    scale_ = header.number("BSCALE").value_or(1);
    const double one = full_scale(bits_, zero_, scale_);
    zero_ /= one;
    scale_ /= one;
    const std::string order = inherited("ROWORDER");
    top_down_ = order == "TOP-DOWN";
    if (!top_down_ && !order.empty() && order != "BOTTOM-UP")
        throw InputError(file_.name(), fmt::format("ROWORDER is \"{}\", which is unknown", order));
    traits_.exposure_us = header.exposure_us();
    if (!traits_.exposure_us) traits_.exposure_us = primary.exposure_us();
    traits_.floating = bits_ < 0;
    add_numbers(header, traits_);
    add_frames(header, slots_, file_.name(), traits_);
    if (bits_ > 0) blank_ = header.number("BLANK");
    traits_.bits = std::max(bits_, 0);
    const std::uint64_t data_end =
        data_offset_ + padded(static_cast<std::uint64_t>(slots_) * frame_bytes);
    if (header.is_primary() && begins_extension(file_, data_end, "XTENSION= 'IMAGE"))
        traits_.warnings.emplace_back("the images in its extensions are left out");
}

std::string FitsReader::where() const {
    return fmt::format("{}: frame {}", file_.name(), next_slot_ - 1);
}

bool FitsReader::read(std::span<float> frame) {
    if (next_slot_ == slots_) return false;
    file_.read(data_offset_ + static_cast<std::uint64_t>(next_slot_++) * bytes_.size(), bytes_);
    const NumberAt number = number_of_kind(bits_);
    const auto rows = static_cast<std::size_t>(shape_.rows);
    const auto cols = static_cast<std::size_t>(shape_.cols);
    const std::size_t number_bytes = bytes_.size() / frame.size();
    for (std::size_t row = 0; row < rows; ++row) {
        const std::uint8_t* stored =
            &bytes_[(top_down_ ? row : rows - 1 - row) * cols * number_bytes];
        for (std::size_t col = 0; col < cols; ++col, stored += number_bytes) {
            const double value = number(stored);
            if (value == blank_)
                throw InputError(where(), fmt::format("row {}, column {}: has no value (BLANK); "
                                                      "repair the footage first",
                                                      row, col));
            frame[row * cols + col] = static_cast<float>(zero_ + scale_ * value);
        }
    }
    return true;
}

}  // namespace stipple
