#include "calibration/calibration_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <fstream>
#include <limits>
#include <string>
#include <system_error>

#include "core/error.h"
#include "core/input_file.h"
#include "core/text.h"
#include "stream/crc32c.h"
#include "stream/little_endian.h"
#include "stream/plain_text.h"

namespace stipple {
namespace {

constexpr std::array<std::uint8_t, 8> kMagic{0x89, 'S', 'T', 'C', 'L', 0x0D, 0x0A, 0x1A};
constexpr std::uint16_t kVersion = 2;        ///< with a response table
constexpr std::uint16_t kLinearVersion = 1;  ///< without
constexpr std::size_t kFixedBytes = 40;      ///< before the name
constexpr std::size_t kCrcBytes = 4;
constexpr std::uint8_t kHasDeviceId = 1;

/// A map of the file: a number of each site, and its limits.
struct SiteMap {
    std::string_view name;
    float SiteCalibration::*number;
    float min;
    float max;
};

constexpr float kMaxMagnitude = 1e12F;
constexpr std::array<SiteMap, 7> kMaps{{
    {"gain", &SiteCalibration::gain, 1e-6F, 1e6F},
    {"gain variance", &SiteCalibration::gain_variance, 0, kMaxMagnitude},
    {"offset", &SiteCalibration::offset_dn, -1e6F, 1e6F},
    {"offset variance", &SiteCalibration::offset_variance_dn2, 0, kMaxMagnitude},
    {"dark current", &SiteCalibration::dark_dn_per_s, -kMaxMagnitude, kMaxMagnitude},
    {"dark current variance", &SiteCalibration::dark_variance, 0, kMaxMagnitude},
    {"readout noise variance", &SiteCalibration::readout_noise_dn2, 0, kMaxMagnitude},
}};
constexpr std::size_t kSiteBytes = kMaps.size() * sizeof(float) + 1;  // and the defect
constexpr std::size_t kTableBytes = 2 * sizeof(float);                // of a DN
constexpr float kMaxLinearDn = 1e6F;

/// The parts of a file before its maps.
struct Head {
    ChipCalibration calibration;  ///< without sites, the response of zeros
    std::size_t bytes = 0;
};

std::size_t dn_count(int bit_depth) {
    return std::size_t{1} << static_cast<unsigned>(bit_depth);
}

FrameShape take_shape(ByteCursor& cursor) {
    FrameShape shape;
    shape.rows = cursor.take<std::uint16_t>();
    shape.cols = cursor.take<std::uint16_t>();
    shape.planes = cursor.take<std::uint8_t>();
    if (shape.rows == 0 || shape.cols == 0 || shape.planes == 0 || shape.planes > 4 ||
        shape.sites() > kMaxFrameSites)
        cursor.fail(fmt::format("an array of {} x {} pixels in {}", shape.cols, shape.rows,
                                counted(shape.planes, "plane")));
    return shape;
}

ColourFilter take_cfa(ByteCursor& cursor, int planes) {
    const auto cfa = cursor.take<std::uint8_t>();
    if (cfa > static_cast<std::uint8_t>(ColourFilter::kBggr) || (cfa != 0 && planes != 1))
        cursor.fail(fmt::format("colour filter array {} of {}", cfa, counted(planes, "plane")));
    return static_cast<ColourFilter>(cfa);
}

std::string take_name(ByteCursor& cursor) {
    const auto bytes = cursor.take<std::uint32_t>();
    if (bytes > kMaxNameBytes) cursor.fail(fmt::format("a name of {} bytes", bytes));
    std::string name;
    for (std::uint32_t i = 0; i < bytes; ++i)
        name += static_cast<char>(cursor.take<std::uint8_t>());
    if (!is_plain_text(name, false)) cursor.fail("the name is not plain text");
    return name;
}

/// Precondition: `bytes` begin with the magic.
Head read_head(std::span<const std::uint8_t> bytes, std::string_view where) {
    ByteCursor cursor(bytes.subspan(kMagic.size()), kMagic.size(), where);
    const auto version = cursor.take<std::uint16_t>();
    if (version != kLinearVersion && version != kVersion)
        cursor.fail(fmt::format("version {} of a calibration; this program reads {} and {}",
                                version, kLinearVersion, kVersion));
    if (cursor.take<std::uint16_t>() != 0) cursor.fail("reserved bytes are not 0");
    Head head;
    ChipCalibration& c = head.calibration;
    c.shape = take_shape(cursor);
    c.cfa = take_cfa(cursor, c.shape.planes);
    c.bit_depth = cursor.take<std::uint8_t>();
    if (c.bit_depth < 1 || c.bit_depth > 16) cursor.fail("a bit depth outside 1..16");
    const auto flags = cursor.take<std::uint8_t>();
    if (flags > kHasDeviceId) cursor.fail("unknown flags");
    const auto device_id = cursor.take<std::uint32_t>();
    if (flags == kHasDeviceId)
        c.chip.device_id = device_id;
    else if (device_id != 0)
        cursor.fail("a device id that the flags deny");
    c.tile_rows = cursor.take<std::uint16_t>();
    c.tile_cols = cursor.take<std::uint16_t>();
    if ((c.tile_rows == 0) != (c.tile_cols == 0)) cursor.fail("a tile without pixels");
    c.flats = cursor.take<std::uint32_t>();
    c.darks = cursor.take<std::uint32_t>();
    c.chip.name = take_name(cursor);
    if (version == kVersion) c.response.linear_dn.resize(dn_count(c.bit_depth));
    head.bytes = bytes.size() - cursor.left();
    return head;
}

void require_size(std::size_t found, std::size_t needed, std::string_view where) {
    if (found < needed)
        throw InputError(fmt::format("{}: byte {}", where, found),
                         fmt::format("the file is truncated: {} bytes of {}", found, needed));
    if (found > needed)
        throw InputError(fmt::format("{}: byte {}", where, needed),
                         "there are bytes after the end of the calibration");
}

void take_maps(ByteCursor& cursor, std::vector<SiteCalibration>& sites) {
    for (const SiteMap& map : kMaps)
        for (SiteCalibration& site : sites) {
            const auto value = std::bit_cast<float>(cursor.take<std::uint32_t>());
            if (!(value >= map.min && value <= map.max))
                cursor.fail(fmt::format("{} {:g} is outside {:g}..{:g}", map.name, value, map.min,
                                        map.max));
            site.*map.number = value;
        }
    for (SiteCalibration& site : sites) {
        const auto defect = cursor.take<std::uint8_t>();
        if (defect > 1) cursor.fail("a defect is neither 0 nor 1");
        site.defect = defect != 0;
    }
}

/// Precondition: the table has its size.
void take_table(ByteCursor& cursor, ResponseTable& table) {
    float before = -std::numeric_limits<float>::infinity();
    for (float& linear_dn : table.linear_dn) {
        linear_dn = std::bit_cast<float>(cursor.take<std::uint32_t>());
        if (!(std::abs(linear_dn) <= kMaxLinearDn && linear_dn > before))
            cursor.fail(
                fmt::format("linear DN {:g} after {:g} in the response table, which rises "
                            "and stays within {:g}",
                            linear_dn, before, kMaxLinearDn));
        before = linear_dn;
    }
    table.variance_dn2.resize(table.linear_dn.size());
    for (float& variance : table.variance_dn2) {
        variance = std::bit_cast<float>(cursor.take<std::uint32_t>());
        if (!(variance >= 0 && variance <= kMaxMagnitude))
            cursor.fail(fmt::format("variance {:g} of the response table is outside 0..{:g}",
                                    variance, kMaxMagnitude));
    }
}

}  // namespace

std::vector<std::uint8_t> encode_chip_calibration(const ChipCalibration& c) {
    assert(c.sites.size() == c.shape.sites());
    std::vector<std::uint8_t> bytes(kMagic.begin(), kMagic.end());
    assert(c.response.linear_dn.empty() || c.response.linear_dn.size() == dn_count(c.bit_depth));
    append(bytes, c.response.linear_dn.empty() ? kLinearVersion : kVersion);
    append(bytes, std::uint16_t{0});
    append(bytes, static_cast<std::uint16_t>(c.shape.rows));
    append(bytes, static_cast<std::uint16_t>(c.shape.cols));
    append(bytes, static_cast<std::uint8_t>(c.shape.planes));
    append(bytes, static_cast<std::uint8_t>(c.cfa));
    append(bytes, static_cast<std::uint8_t>(c.bit_depth));
    append(bytes, std::uint8_t{c.chip.device_id ? kHasDeviceId : std::uint8_t{0}});
    append(bytes, c.chip.device_id.value_or(0));
    append(bytes, static_cast<std::uint16_t>(c.tile_rows));
    append(bytes, static_cast<std::uint16_t>(c.tile_cols));
    append(bytes, c.flats);
    append(bytes, c.darks);
    append(bytes, static_cast<std::uint32_t>(c.chip.name.size()));
    bytes.insert(bytes.end(), c.chip.name.begin(), c.chip.name.end());
    bytes.reserve(bytes.size() + c.sites.size() * kSiteBytes + kCrcBytes);
    for (const SiteMap& map : kMaps)
        for (const SiteCalibration& site : c.sites)
            append(bytes, std::bit_cast<std::uint32_t>(site.*map.number));
    for (const SiteCalibration& site : c.sites)
        append(bytes, static_cast<std::uint8_t>(site.defect ? 1 : 0));
    for (const float dn : c.response.linear_dn) append(bytes, std::bit_cast<std::uint32_t>(dn));
    for (const float v : c.response.variance_dn2) append(bytes, std::bit_cast<std::uint32_t>(v));
    append(bytes, crc32c(bytes));
    return bytes;
}

ChipCalibration decode_chip_calibration(std::span<const std::uint8_t> bytes,
                                        std::string_view where) {
    const auto there = std::min(bytes.size(), kMagic.size());
    if (there == 0 || !std::equal(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(there),
                                  kMagic.begin()))
        throw InputError(where, "is not a calibration file, which \"stipple calibrate\" writes");
    if (bytes.size() < kFixedBytes + kCrcBytes)
        require_size(bytes.size(), kFixedBytes + kCrcBytes, where);
    Head head = read_head(bytes, where);
    const std::size_t sites = head.calibration.shape.sites();
    const std::size_t table_bytes = head.calibration.response.linear_dn.size() * kTableBytes;
    require_size(bytes.size(), head.bytes + sites * kSiteBytes + table_bytes + kCrcBytes, where);
    const std::size_t crc_at = bytes.size() - kCrcBytes;
    if (load<std::uint32_t>(&bytes[crc_at]) != crc32c(bytes.first(crc_at)))
        throw InputError(fmt::format("{}: byte {}", where, crc_at),
                         "the file is damaged (wrong CRC); calibrate again");
    head.calibration.sites.resize(sites);
    ByteCursor cursor(bytes.subspan(head.bytes), head.bytes, where);
    take_maps(cursor, head.calibration.sites);
    take_table(cursor, head.calibration.response);
    return std::move(head.calibration);
}

bool is_chip_calibration(const std::filesystem::path& path) {
    std::error_code error;  // the reader of the file says what it is
    if (!std::filesystem::is_regular_file(path, error)) return false;
    std::array<char, kMagic.size()> start{};
    std::ifstream file(path, std::ios::binary);
    return file.read(start.data(), start.size()) &&
           std::equal(start.begin(), start.end(), kMagic.begin(), [](char c, std::uint8_t byte) {
               return static_cast<std::uint8_t>(c) == byte;
           });
}

std::filesystem::path calibration_beside(const std::filesystem::path& stream) {
    std::filesystem::path file = stream;
    file.replace_extension(".stcal");
    std::error_code error;  // what cannot be looked at is not there
    return std::filesystem::is_regular_file(file, error) ? file : std::filesystem::path{};
}

ChipCalibration read_chip_calibration(const std::filesystem::path& file) {
    return decode_chip_calibration(read_file(file), file.string());
}

}  // namespace stipple
