#include "readout/schedules/schedule_catalogue.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>

#include "core/config.h"
#include "core/error.h"
#include "core/memory_limit.h"
#include "core/named_value.h"
#include "readout/column_addressing.h"
#include "readout/schedules/cell_schedule.h"
#include "readout/schedules/code_schedule.h"
#include "readout/schedules/hardware_tiled.h"
#include "readout/schedules/random_codes.h"
#include "readout/schedules/tiled_schedule.h"
#include "stream/plain_text.h"

namespace stipple {
namespace {

constexpr KeyRange kExposure{1, kMaxExposureSlots};
constexpr KeyRange kPeriod{1, kMaxPeriodSlots};
constexpr ConfigKey kOpenSlots{"open_slots", kExposure, "slots", "open slots of an exposure"};
constexpr ConfigKey kPeriodSlots{"period_slots", kPeriod, "slots", "period of the schedule"};

/// What a schedule is made for.
struct BuildContext {
    FrameShape shape;
    std::uint64_t seed;
    ColumnAddressing addressing;
};

std::vector<int> read_exposure_slots(Config& config) {
    std::vector<int> lengths(std::begin(kPaperExposureSlots), std::end(kPaperExposureSlots));
    const ConfigKey key{"exposure_slots", kExposure, "slots", "lengths of a pixel's exposures"};
    const KeyReader read(config);
    read(key, lengths);
    if (lengths.empty() || lengths.size() > kMaxTiledLengths)
        throw InputError(config.where(key.name), fmt::format("holds {} lengths; give 1 to {}",
                                                             lengths.size(), kMaxTiledLengths));
    return lengths;
}

void read_tile_size(Config& config, KeyRange range, int& rows, int& cols) {
    const KeyReader read(config);
    read({"tile_rows", range, "pixels", "rows of the tile"}, rows);
    read({"tile_cols", range, "pixels", "columns of the tile"}, cols);
}

NamedSchedule read_random(Config& config, const BuildContext& made) {
    const FrameShape shape = made.shape;
    std::vector<int> lengths = read_exposure_slots(config);
    if (shape.pixels() * lengths.size() > kMaxRandomExposures)
        throw InputError(config.where("kind"),
                         fmt::format("random exposures of {} x {} pixels are too many for a "
                                     "stream; give ",
                                     shape.cols, shape.rows) +
                             Parameter{"schedule", "tiled"});
    // It is kept twice: by the sensor, and in the header of the stream.
    check_memory(2 * random_schedule_bytes(shape.rows, shape.cols, lengths), config.where("kind"),
                 fmt::format("random exposures of {} x {} pixels", shape.cols, shape.rows));
    ExposureSchedule schedule = random_schedule(shape.rows, shape.cols, lengths, made.seed);
    return {.name = "random",
            .source = ScheduleSource{ScheduleSource::Kind::kRandom, std::move(lengths), made.seed},
            .schedule = std::move(schedule)};
}

NamedSchedule read_tiled(Config& config, const BuildContext& made) {
    int rows = 16, cols = 16;
    read_tile_size(config, {1, kMaxTiledSide}, rows, cols);
    const std::vector<int> lengths = read_exposure_slots(config);
    return {"tiled", {}, tiled_schedule(rows, cols, lengths, made.seed)};
}

NamedSchedule read_full(Config& config, const BuildContext& /*made*/) {
    const KeyReader read(config);
    int open_slots = 4, period_slots = 4;
    read(kOpenSlots, open_slots);
    read(kPeriodSlots, period_slots);
    if (open_slots > period_slots)
        throw InputError(config.where(kOpenSlots.name),
                         fmt::format("{} is more than period_slots, {}", open_slots, period_slots));
    return {"full", {}, full_schedule(open_slots, period_slots)};
}

/// One value for each of `pixels` pixels, or one for all.
std::vector<int> read_per_pixel(Config& config, const ConfigKey& key, int fallback,
                                std::size_t pixels) {
    std::vector<int> values = config.integers(key, {fallback});
    if (values.size() == 1) values.resize(pixels, values.front());
    if (values.size() != pixels)
        throw InputError(config.where(key.name),
                         fmt::format("holds {} values; give one for each of the {} pixels of the "
                                     "cell, or one for all",
                                     values.size(), pixels));
    return values;
}

void check_exposures(const Config& config, const char* key, std::uint64_t exposures) {
    if (exposures > kMaxTileExposures)
        throw InputError(config.where(key),
                         fmt::format("the tile has {} exposures; 2^24 fit a stream", exposures));
}

/// What `make` returns, its errors at `key`.
template <typename Make>
ExposureSchedule at_key(const Config& config, const char* key, const Make& make) {
    try {
        return make();
    } catch (const InputError& error) {
        throw InputError(config.where(key), error.message());
    }
}

NamedSchedule read_cell(Config& config, const BuildContext& /*made*/) {
    Cell cell;
    read_tile_size(config, {1, kMaxTiledSide}, cell.rows, cell.cols);
    const auto pixels = static_cast<std::size_t>(cell.rows) * static_cast<std::size_t>(cell.cols);
    cell.exposure_slots = read_per_pixel(
        config,
        {"exposure_slots", kExposure, "slots", "length of the exposures; a list: of each pixel"}, 4,
        pixels);
    cell.every_slots = read_per_pixel(
        config, {"every_slots", kPeriod, "slots", "distance of exposures; a list: of each pixel"},
        4, pixels);
    cell.first_slots = read_per_pixel(config,
                                      {"first_slots",
                                       {0, kMaxPeriodSlots},
                                       "slots",
                                       "beginning of the first; a list: of each pixel"},
                                      0, pixels);
    return {"cell", {}, at_key(config, "every_slots", [&] { return cell_schedule(cell); })};
}

NamedSchedule read_rolling(Config& config, const BuildContext& made) {
    const KeyReader read(config);
    RollingShutter shutter{.exposure_slots = 4, .period_slots = 4, .rows_per_slot = 0};
    read({"exposure_slots", kExposure, "slots", "open slots of an exposure"},
         shutter.exposure_slots);
    read(kPeriodSlots, shutter.period_slots);
    read({"rows_per_slot", {0, kMaxTileSide}, "rows", "begin in a slot; 0: all once a period"},
         shutter.rows_per_slot);
    if (shutter.rows_per_slot == 0)
        shutter.rows_per_slot = (made.shape.rows + shutter.period_slots - 1) / shutter.period_slots;
    return {"rolling", {}, at_key(config, "exposure_slots", [&] {
                return rolling_schedule(shutter, made.shape.rows);
            })};
}

NamedSchedule read_scattered(Config& config, const BuildContext& made) {
    const KeyReader read(config);
    Scatter scatter{.tile_rows = 16, .tile_cols = 16, .period_slots = 16};
    read_tile_size(config, {1, kMaxTiledSide}, scatter.tile_rows, scatter.tile_cols);
    read(kPeriodSlots, scatter.period_slots);
    read({"wrap", {}, "", "whether exposures may go on beyond the period"}, scatter.wrap);
    const std::vector<int> lengths = read_exposure_slots(config);
    return {"scattered", {}, at_key(config, "exposure_slots", [&] {
                return scattered_schedule(scatter, lengths, made.seed);
            })};
}

NamedSchedule read_flutter(Config& config, const BuildContext& made) {
    const KeyReader read(config);
    Flutter flutter{.tile_rows = 16, .tile_cols = 16, .code_slots = 8, .open_slots = 4};
    read_tile_size(config, {1, kMaxTiledSide}, flutter.tile_rows, flutter.tile_cols);
    read({"code_slots", kExposure, "slots", "length of a code"}, flutter.code_slots);
    read(kOpenSlots, flutter.open_slots);
    read({"codes", kPeriod, "", "number of codes in the period"}, flutter.codes);
    read({"complement", {}, "", "whether the second charge store takes the closed slots"},
         flutter.complement);
    check_exposures(config, "codes",
                    std::uint64_t{2} * static_cast<std::uint64_t>(flutter.tile_rows) *
                        static_cast<std::uint64_t>(flutter.tile_cols) *
                        static_cast<std::uint64_t>(flutter.codes));
    return {"flutter", {}, at_key(config, "open_slots", [&] {
                return flutter_schedule(flutter, made.seed);
            })};
}

NamedSchedule read_code(Config& config, const BuildContext& /*made*/) {
    TileSize size{.rows = 1, .cols = 1, .period_slots = 1};
    read_tile_size(config, {1, kMaxTileSide}, size.rows, size.cols);
    const KeyReader read(config);
    read(kPeriodSlots, size.period_slots);
    const ConfigKey key{"code", {}, "", "exposure code: a text per pixel, a character per slot"};
    const std::vector<std::string> code = config.texts(key);
    if (code.size() * static_cast<std::size_t>(size.period_slots) > kMaxCodeSlots)
        throw InputError(config.where(key.name),
                         fmt::format("{} pixels of {} slots are more than the 2^24 characters that "
                                     "a code may have; use a smaller tile",
                                     code.size(), size.period_slots));
    NamedSchedule result{"code", {}, code_schedule(size, code, config.where(key.name))};
    const ConfigKey of_weights{
        "weights", {}, "", "weights of the slots: a text per pixel, four digits per slot"};
    const std::vector<std::string> texts = config.texts(of_weights);
    if (texts.empty()) return result;
    auto weights = code_weights(size, texts, config.where(of_weights.name));
    result.schedule = at_key(config, "weights", [&] {
        ExposureSchedule weighted = std::move(result.schedule);
        weighted.set_weights(std::move(weights));
        return weighted;
    });
    return result;
}

constexpr auto kArrangements =
    std::to_array<NamedValue<TileArrangement>>({{"auto", TileArrangement::kAuto},
                                                {"lattice", TileArrangement::kLattice},
                                                {"scatter", TileArrangement::kScatter},
                                                {"random", TileArrangement::kRandom}});

NamedSchedule read_hardware_tiled(Config& config, const BuildContext& made) {
    const KeyReader read(config);
    HardwareTile tile{.addressing = made.addressing, .array_cols = made.shape.cols};
    read_addressing(read, tile.addressing);
    read_tile_size(config, {0, kMaxHardwareSide}, tile.tile_rows, tile.tile_cols);
    read({"arrangement", {}, "", "arrangement of the codes in the tile", kNamesOf<kArrangements>},
         tile.arrangement);
    const std::vector<int> lengths = read_exposure_slots(config);
    return {"hardware_tiled", {}, at_key(config, "kind", [&] {
                return hardware_tiled_schedule(tile, lengths, made.seed);
            })};
}

struct Kind {
    std::string_view name;
    NamedSchedule (*read)(Config& config, const BuildContext& made);
};
constexpr Kind kKinds[] = {
    {"random", read_random},
    {"tiled", read_tiled},
    {"hardware_tiled", read_hardware_tiled},
    {"full", read_full},
    {"cell", read_cell},
    {"rolling", read_rolling},
    {"scattered", read_scattered},
    {"flutter", read_flutter},
    {"code", read_code},
};

}  // namespace

std::vector<std::string_view> schedule_kinds() {
    std::vector<std::string_view> names;
    for (const Kind& kind : kKinds) names.push_back(kind.name);
    return names;
}

std::vector<KnownKey> known_schedule_keys(std::string_view kind) {
    // The code is for the kind of that name, which has no default.
    Config config({fmt::format("kind={}", kind), "code=[\"A\"]"});
    static_cast<void>(read_schedule(config, {1, 1, 1}, 0));
    return config.known_keys();
}

NamedSchedule read_schedule(Config& config, FrameShape shape, std::uint64_t seed,
                            const ColumnAddressing& addressing) {
    const auto names = schedule_kinds();
    const Kind& kind = kKinds[config.choice({"kind", {}, "", "kind of schedule", names}, 0)];
    NamedSchedule result = kind.read(config, {shape, seed, addressing});
    const ConfigKey name{"name", {}, "", "name in messages and in the header of streams"};
    result.name = config.text(name, kind.name);
    if (result.name.size() > kMaxNameBytes)
        throw InputError(config.where(name.name),
                         fmt::format("has {} bytes; at most {} fit a stream", result.name.size(),
                                     kMaxNameBytes));
    if (!is_plain_text(result.name, false))
        throw InputError(config.where(name.name), "has control characters, or is not UTF-8");
    return result;
}

NamedSchedule read_schedule(Config& config, FrameShape shape, std::uint64_t seed) {
    return read_schedule(config, shape, seed, ColumnAddressing{});
}

}  // namespace stipple
