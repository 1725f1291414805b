#include "readout/schedules/schedule_catalogue.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>

#include "core/error.h"
#include "core/memory_limit.h"
#include "readout/schedules/cell_schedule.h"
#include "readout/schedules/code_schedule.h"
#include "readout/schedules/full_schedule.h"
#include "readout/schedules/hardware_tiled.h"
#include "readout/schedules/random_codes.h"
#include "readout/schedules/tiled_schedule.h"
#include "readout/timing/column_addressing.h"

namespace stipple {
namespace {

constexpr int kLongestExposure = 64;  ///< slots: the bits of `Exposure::open_slots`
constexpr int kLongestPeriod = 65535;
constexpr std::size_t kMaxLengths = 255;
constexpr std::size_t kLongestName = 64;                ///< bytes in a stream header
constexpr std::size_t kMaxRandomExposures = 1U << 25U;  ///< of a stream (docs/stream_format.md)
constexpr std::size_t kMaxTileExposures = 1U << 24U;    ///< the same
constexpr int kLargestTileSide = 256;
constexpr int kMaxChannels = 4096;  ///< of a sensor

std::vector<int> read_exposure_slots(Config& config) {
    constexpr char kKey[] = "exposure_slots";
    const std::vector<int> paper(std::begin(kPaperExposureSlots), std::end(kPaperExposureSlots));
    std::vector<int> lengths = config.integers(kKey, paper, 1, kLongestExposure);
    if (lengths.empty() || lengths.size() > kMaxLengths)
        throw InputError(config.place(kKey), fmt::format("holds {} lengths; give 1 to {}",
                                                         lengths.size(), kMaxLengths));
    return lengths;
}

int read_int(Config& config, const char* key, int fallback, int most) {
    return static_cast<int>(config.integer(key, fallback, 1, most));
}

NamedSchedule read_random(Config& config, FrameShape shape, std::uint64_t seed) {
    std::vector<int> lengths = read_exposure_slots(config);
    if (shape.pixels() * lengths.size() > kMaxRandomExposures)
        throw InputError(config.place("kind"),
                         fmt::format("random exposures of {} x {} pixels are too many for a "
                                     "stream; use the schedule \"tiled\"",
                                     shape.rows, shape.cols));
    // It is kept twice: by the sensor, and in the header of the stream.
    check_memory(2 * random_schedule_bytes(shape.rows, shape.cols, lengths), config.place("kind"),
                 fmt::format("random exposures of {} x {} pixels", shape.rows, shape.cols));
    ExposureSchedule schedule = random_schedule(shape.rows, shape.cols, lengths, seed);
    return {.name = "random",
            .source = {ScheduleSource::Kind::kRandom, std::move(lengths), seed},
            .schedule = std::move(schedule)};
}

NamedSchedule read_tiled(Config& config, std::uint64_t seed) {
    const int rows = read_int(config, "tile_rows", 16, kLargestTileSide);
    const int cols = read_int(config, "tile_cols", 16, kLargestTileSide);
    const std::vector<int> lengths = read_exposure_slots(config);
    return {"tiled", {}, tiled_schedule(rows, cols, lengths, seed)};
}

NamedSchedule read_full(Config& config) {
    const int open_slots = read_int(config, "open_slots", 4, kLongestExposure);
    const int period_slots = read_int(config, "period_slots", 4, kLongestPeriod);
    if (open_slots > period_slots)
        throw InputError(config.place("open_slots"),
                         fmt::format("{} is more than period_slots, {}", open_slots, period_slots));
    return {"full", {}, full_schedule(open_slots, period_slots)};
}

struct Limits {
    int least;
    int most;
};

/// One value for each of `pixels` pixels, or one for all.
std::vector<int> read_per_pixel(Config& config, const char* key, int fallback, Limits limits,
                                std::size_t pixels) {
    std::vector<int> values = config.integers(key, {fallback}, limits.least, limits.most);
    if (values.size() == 1) values.resize(pixels, values.front());
    if (values.size() != pixels)
        throw InputError(config.place(key), fmt::format("holds {} values; give one for each of the "
                                                        "{} pixels of the cell, or one for all",
                                                        values.size(), pixels));
    return values;
}

void check_exposures(const Config& config, const char* key, std::uint64_t exposures) {
    if (exposures > kMaxTileExposures)
        throw InputError(config.place(key),
                         fmt::format("the tile has {} exposures; 2^24 fit a stream", exposures));
}

/// What `make` returns, its errors at `key`.
template <typename Make>
ExposureSchedule at_key(const Config& config, const char* key, const Make& make) {
    try {
        return make();
    } catch (const InputError& error) {
        throw InputError(config.place(key), error.what());
    }
}

NamedSchedule read_cell(Config& config) {
    Cell cell;
    cell.rows = read_int(config, "tile_rows", 1, kLargestTileSide);
    cell.cols = read_int(config, "tile_cols", 1, kLargestTileSide);
    const auto pixels = static_cast<std::size_t>(cell.rows) * static_cast<std::size_t>(cell.cols);
    cell.exposure_slots =
        read_per_pixel(config, "exposure_slots", 4, {1, kLongestExposure}, pixels);
    cell.every_slots = read_per_pixel(config, "every_slots", 4, {1, kLongestPeriod}, pixels);
    cell.first_slots = read_per_pixel(config, "first_slots", 0, {0, kLongestPeriod}, pixels);
    return {"cell", {}, at_key(config, "every_slots", [&] { return cell_schedule(cell); })};
}

NamedSchedule read_rolling(Config& config, FrameShape shape) {
    RollingShutter shutter;
    shutter.exposure_slots = read_int(config, "exposure_slots", 4, kLongestExposure);
    shutter.period_slots = read_int(config, "period_slots", 4, kLongestPeriod);
    const auto rows = static_cast<int>(config.integer("rows_per_slot", 0, 0, kLongestPeriod));
    shutter.rows_per_slot =
        rows > 0 ? rows : (shape.rows + shutter.period_slots - 1) / shutter.period_slots;
    return {"rolling", {}, at_key(config, "exposure_slots", [&] {
                return rolling_schedule(shutter, shape.rows);
            })};
}

NamedSchedule read_scattered(Config& config, std::uint64_t seed) {
    Scatter scatter;
    scatter.tile_rows = read_int(config, "tile_rows", 16, kLargestTileSide);
    scatter.tile_cols = read_int(config, "tile_cols", 16, kLargestTileSide);
    scatter.period_slots = read_int(config, "period_slots", 16, kLongestPeriod);
    scatter.wrap = config.boolean("wrap", true);
    const std::vector<int> lengths = read_exposure_slots(config);
    return {"scattered", {}, at_key(config, "exposure_slots", [&] {
                return scattered_schedule(scatter, lengths, seed);
            })};
}

NamedSchedule read_flutter(Config& config, std::uint64_t seed) {
    Flutter flutter;
    flutter.tile_rows = read_int(config, "tile_rows", 16, kLargestTileSide);
    flutter.tile_cols = read_int(config, "tile_cols", 16, kLargestTileSide);
    flutter.code_slots = read_int(config, "code_slots", 8, kLongestExposure);
    flutter.open_slots = read_int(config, "open_slots", 4, kLongestExposure);
    flutter.codes = read_int(config, "codes", 1, kLongestPeriod);
    flutter.complement = config.boolean("complement", false);
    check_exposures(config, "codes",
                    std::uint64_t{2} * static_cast<std::uint64_t>(flutter.tile_rows) *
                        static_cast<std::uint64_t>(flutter.tile_cols) *
                        static_cast<std::uint64_t>(flutter.codes));
    return {"flutter", {}, at_key(config, "open_slots", [&] {
                return flutter_schedule(flutter, seed);
            })};
}

NamedSchedule read_code(Config& config) {
    const TileSize size{.rows = read_int(config, "tile_rows", 1, kLongestPeriod),
                        .cols = read_int(config, "tile_cols", 1, kLongestPeriod),
                        .period_slots = read_int(config, "period_slots", 1, kLongestPeriod)};
    const std::vector<std::string> code = config.texts("code");
    if (code.size() * static_cast<std::size_t>(size.period_slots) > kMaxCodeSlots)
        throw InputError(config.place("code"),
                         fmt::format("{} pixels of {} slots are more than the 2^24 characters that "
                                     "a code may have; use a smaller tile",
                                     code.size(), size.period_slots));
    return {"code", {}, code_schedule(size, code, config.place("code"))};
}

/// What a schedule is made for.
struct Made {
    FrameShape shape;
    std::uint64_t seed;
    ColumnAddressing addressing;
};

ColumnAddressing read_addressing(Config& config, ColumnAddressing addressing) {
    using enum ColumnAddressing::Kind;
    const std::string kind =
        config.choice("addressing", addressing.kind == kGroup ? "group" : "skip_channel",
                      {"skip_channel", "group"});
    addressing.kind = kind == "group" ? kGroup : kSkipChannel;
    addressing.channels = read_int(config, "channels", addressing.channels, kMaxChannels);
    addressing.group_cols = read_int(config, "group_cols", addressing.group_cols, kLongestPeriod);
    addressing.group_rows = read_int(config, "group_rows", addressing.group_rows, kLongestPeriod);
    return addressing;
}

NamedSchedule read_hardware_tiled(Config& config, const Made& made) {
    using enum TileArrangement;
    const auto side = [&](const char* key) {
        return static_cast<int>(config.integer(key, 0, 0, kLongestHardwareSide));
    };
    HardwareTile tile{.addressing = read_addressing(config, made.addressing),
                      .tile_rows = side("tile_rows"),
                      .tile_cols = side("tile_cols"),
                      .array_cols = made.shape.cols};
    const std::string arrangement =
        config.choice("arrangement", "auto", {"auto", "lattice", "scatter", "random"});
    tile.arrangement = arrangement == "lattice"   ? kLattice
                       : arrangement == "scatter" ? kScatter
                       : arrangement == "random"  ? kRandom
                                                  : kAuto;
    const std::vector<int> lengths = read_exposure_slots(config);
    return {"hardware_tiled", {}, at_key(config, "kind", [&] {
                return hardware_tiled_schedule(tile, lengths, made.seed);
            })};
}

struct Kind {
    const char* name;
    std::function<NamedSchedule(Config&, const Made&)> read;
};

const std::vector<Kind>& kinds() {
    static const std::vector<Kind> all = {
        {"random", [](Config& c, const Made& m) { return read_random(c, m.shape, m.seed); }},
        {"tiled", [](Config& c, const Made& m) { return read_tiled(c, m.seed); }},
        {"hardware_tiled", read_hardware_tiled},
        {"full", [](Config& c, const Made&) { return read_full(c); }},
        {"cell", [](Config& c, const Made&) { return read_cell(c); }},
        {"rolling", [](Config& c, const Made& m) { return read_rolling(c, m.shape); }},
        {"scattered", [](Config& c, const Made& m) { return read_scattered(c, m.seed); }},
        {"flutter", [](Config& c, const Made& m) { return read_flutter(c, m.seed); }},
        {"code", [](Config& c, const Made&) { return read_code(c); }},
    };
    return all;
}

}  // namespace

NamedSchedule read_schedule(Config& config, FrameShape shape, std::uint64_t seed,
                            const ColumnAddressing& addressing) {
    std::vector<std::string> names;
    for (const Kind& kind : kinds()) names.emplace_back(kind.name);
    const std::string kind = config.choice("kind", "random", names);
    const auto found = std::ranges::find(kinds(), kind, &Kind::name);
    NamedSchedule result = found->read(config, {shape, seed, addressing});
    result.name = config.text("name", kind);
    if (result.name.size() > kLongestName)
        throw InputError(config.place("name"), fmt::format("has {} bytes; at most {} fit a stream",
                                                           result.name.size(), kLongestName));
    return result;
}

NamedSchedule read_schedule(Config& config, FrameShape shape, std::uint64_t seed) {
    return read_schedule(config, shape, seed, ColumnAddressing{});
}

}  // namespace stipple
