// Keys and their meaning: ImageJ, OME-XML, tifffile (docs/references.md).
#include "io/tiff_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <utility>

#include "core/error.h"

namespace stipple {
namespace {

/// What follows `key`, up to one of `ends`; empty if there is no such key.
std::string_view value_of(std::string_view text, std::string_view key, std::string_view ends) {
    const auto found = text.find(key);
    if (found == std::string_view::npos) return {};
    text.remove_prefix(found + key.size());
    return text.substr(0, text.find_first_of(ends));
}

/// The number that `text` begins with; 0 if there is none.
template <typename Number>
Number number_of(std::string_view text) {
    Number number{};
    const auto result = std::from_chars(text.data(), text.data() + text.size(), number);
    return result.ec == std::errc() ? number : Number{};
}

/// A number that stands for 1 where it is not declared.
std::uint64_t size_of(std::string_view text) {
    return std::max<std::uint64_t>(number_of<std::uint64_t>(text), 1);
}

/// \throws InputError as pages, which `declared` names, are no moments in time.
[[noreturn]] void refuse(std::string_view declared, const TiffExtent& extent,
                         const std::string& where) {
    throw InputError(
        where,
        fmt::format("declares {} for its {} pages, but each page becomes a moment in time; save "
                    "one channel and focal plane a file, or declare pages that are moments as such "
                    "(frames= of ImageJ, SizeT of OME, axes TYX)",
                    declared, extent.pages));
}

/// Of frames so long apart, in a unit of time; nothing for any other unit.
std::optional<double> rate_of(double interval, std::string_view unit) {
    constexpr std::array<std::pair<std::string_view, double>, 12> kSeconds{
        {{"", 1},
         {"s", 1},
         {"sec", 1},
         {"ms", 1e-3},
         {"msec", 1e-3},
         {"us", 1e-6},
         {"usec", 1e-6},
         {"\xC2\xB5s", 1e-6},  // micro sign and mu
         {"\xCE\xBCs", 1e-6},
         {"\\u00B5sec", 1e-6},
         {"ns", 1e-9},
         {"min", 60}}};
    const auto* const known =
        std::ranges::find(kSeconds, unit, &std::pair<std::string_view, double>::first);
    if (known == kSeconds.end() || !(interval > 0)) return {};
    const double rate_hz = 1 / (interval * known->second);
    return rate_hz > 0 && rate_hz < 1e9 ? std::optional(rate_hz) : std::nullopt;
}

/// Of a stack beyond 4 GB, ImageJ writes the first page, and says how many follow.
TiffTimes times_of_imagej(std::string_view text, const TiffExtent& extent,
                          const std::string& where) {
    const auto value = [text](std::string_view key) { return value_of(text, key, "\r\n"); };
    const std::uint64_t images = size_of(value("\nimages="));
    if (images > extent.pages)
        throw InputError(where, fmt::format("announces {} images, but its directories hold {}; "
                                            "save it from ImageJ as an image sequence",
                                            images, extent.pages));
    TiffTimes times{.frames_hz =
                        rate_of(number_of<double>(value("\nfinterval=")), value("\ntunit="))};
    if (extent.pages == 1) return times;
    // ImageJ shows up to 7 channels. tifffile declares the pages of any bare array as such.
    constexpr std::uint64_t kMaxChannels = 7;
    const std::uint64_t channels = size_of(value("\nchannels="));
    const std::uint64_t slices = size_of(value("\nslices="));
    if (channels > kMaxChannels && channels == extent.pages) {
        times.warnings.push_back(fmt::format(
            "declares {} channels, more than ImageJ shows; each is taken for a moment in time",
            channels));
        return times;
    }
    if (channels > 1) refuse(fmt::format("{} channels", channels), extent, where);
    if (slices == 1) return times;
    if (size_of(value("\nframes=")) > 1 || value("\nhyperstack=") == "true")
        refuse(fmt::format("{} slices", slices), extent, where);
    times.warnings.push_back(fmt::format(
        "declares {} slices, as ImageJ calls the images of any stack; each is taken for a moment "
        "in time",
        slices));
    return times;
}

TiffTimes times_of_ome(std::string_view text, const TiffExtent& extent, const std::string& where) {
    const std::string_view prefix = text.find("<OME:Pixels ") == text.npos ? "<" : "<OME:";
    const std::string_view pixels = value_of(text, fmt::format("{}Pixels ", prefix), ">");
    const auto value = [pixels](std::string_view key) { return value_of(pixels, key, "\""); };
    TiffTimes times{.frames_hz = rate_of(number_of<double>(value(" TimeIncrement=\"")),
                                         value(" TimeIncrementUnit=\""))};
    if (extent.pages == 1) return times;
    const std::uint64_t channels = size_of(value(" SizeC=\"")) / extent.channels;
    const std::uint64_t slices = size_of(value(" SizeZ=\""));
    if (channels > 1) refuse(fmt::format("{} channels (SizeC)", channels), extent, where);
    if (slices > 1) refuse(fmt::format("{} focal planes (SizeZ)", slices), extent, where);
    const std::uint64_t moments = size_of(value(" SizeT=\""));
    const std::string image = fmt::format("{}Image ", prefix);
    if (extent.pages > moments && text.find(image) != text.rfind(image))
        refuse("several images", extent, where);
    if (extent.pages != moments)
        times.warnings.push_back(
            fmt::format("declares {} moments in time (SizeT), but holds {} "
                        "pages, which are read",
                        moments, extent.pages));
    return times;
}

/// The array that the first pages make up, by its shape and, in some files, its axes.
TiffTimes times_of_tifffile(std::string_view text, const TiffExtent& extent,
                            const std::string& where) {
    std::string_view list = value_of(text, "\"shape\": [", "]");
    const std::string_view axes = value_of(text, "\"axes\": \"", "\"");
    const std::string shape(list);
    constexpr std::size_t kMaxAxes = 16;
    std::vector<std::uint64_t> sizes;
    while (!list.empty() && sizes.size() < kMaxAxes) {
        list.remove_prefix(std::min(list.find_first_of("0123456789"), list.size()));
        if (!list.empty()) sizes.push_back(size_of(list));
        list.remove_prefix(std::min(list.find(','), list.size()));
    }
    std::size_t of_pages = sizes.size();  // the last axes are those of a page
    for (std::uint64_t rest = extent.page_samples; of_pages > 0 && rest > 1;
         rest /= sizes[of_pages])
        if (rest % sizes[--of_pages] != 0) return {};
    std::uint64_t announced = 1;
    std::size_t axes_of_pages = 0;
    for (std::size_t i = 0; i < of_pages; ++i) {
        if (sizes[i] == 1) continue;
        ++axes_of_pages;
        if (announced <= extent.pages) announced *= std::min(sizes[i], std::uint64_t{1} << 31U);
        constexpr std::string_view kMoments = "TIQ";  // time, an index, unknown
        if (axes.size() == sizes.size() && kMoments.find(axes[i]) == kMoments.npos)
            refuse(fmt::format("the axes {} of {}", axes, shape), extent, where);
    }
    if (announced > extent.pages)
        throw InputError(where, fmt::format("announces an array of {}, but its directories hold "
                                            "{} pages; save it with all its pages",
                                            shape, extent.pages));
    if (axes_of_pages > 1) refuse(fmt::format("an array of {}", shape), extent, where);
    return {};
}

}  // namespace

TiffTimes times_of_pages(std::string_view description, const TiffExtent& extent,
                         const std::string& where) {
    if (description.starts_with("ImageJ=")) return times_of_imagej(description, extent, where);
    if (description.find("openmicroscopy.org/Schemas/") != description.npos)
        return times_of_ome(description, extent, where);
    if (description.starts_with('{')) return times_of_tifffile(description, extent, where);
    return {};
}

}  // namespace stipple
