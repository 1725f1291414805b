#include "readout/schedule_catalogue.h"

#include <fmt/format.h>

#include "core/error.h"

namespace stipple {
namespace {

constexpr int kLongestExposure = 64;  ///< slots: the bits of `Exposure::open_slots`
constexpr int kLongestPeriod = 65535;
constexpr std::size_t kMostLengths = 255;
constexpr std::size_t kLongestName = 64;                 ///< bytes in a stream header
constexpr std::size_t kMostRandomExposures = 1U << 25U;  ///< of a stream (docs/stream_format.md)
constexpr int kLargestTileSide = 256;

std::vector<int> read_exposure_slots(Config& config) {
    constexpr char kKey[] = "exposure_slots";
    const std::vector<int> paper(std::begin(kPaperExposureSlots), std::end(kPaperExposureSlots));
    std::vector<int> lengths = config.integers(kKey, paper, 1, kLongestExposure);
    if (lengths.empty() || lengths.size() > kMostLengths)
        throw InputError(config.place(kKey), fmt::format("holds {} lengths; give 1 to {}",
                                                         lengths.size(), kMostLengths));
    return lengths;
}

int read_int(Config& config, const char* key, int fallback, int most) {
    return static_cast<int>(config.integer(key, fallback, 1, most));
}

NamedSchedule read_random(Config& config, FrameShape shape, std::uint64_t seed) {
    std::vector<int> lengths = read_exposure_slots(config);
    if (shape.pixels() * lengths.size() > kMostRandomExposures)
        throw InputError(config.place("kind"),
                         fmt::format("random exposures of {} x {} pixels are too many for a "
                                     "stream; use the schedule \"tiled\"",
                                     shape.rows, shape.cols));
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

}  // namespace

NamedSchedule read_schedule(Config& config, FrameShape shape, std::uint64_t seed) {
    const std::string kind = config.choice("kind", "random", {"random", "tiled", "full"});
    NamedSchedule result = kind == "random"  ? read_random(config, shape, seed)
                           : kind == "tiled" ? read_tiled(config, seed)
                                             : read_full(config);
    result.name = config.text("name", kind);
    if (result.name.size() > kLongestName)
        throw InputError(config.place("name"), fmt::format("has {} bytes; at most {} fit a stream",
                                                           result.name.size(), kLongestName));
    return result;
}

ExposureSchedule full_schedule(int open_slots, int period_slots) {
    if (open_slots < 1 || open_slots > kLongestExposure || open_slots > period_slots)
        throw InputError("exposure schedule",
                         fmt::format("{} open slots in a period of {}: needs 1 to {} open slots "
                                     "and a period not shorter",
                                     open_slots, period_slots, kLongestExposure));
    const auto mask = ~std::uint64_t{0} >> static_cast<unsigned>(kLongestExposure - open_slots);
    return {1, 1, period_slots, {0, 1}, {{0, mask}}};
}

}  // namespace stipple
