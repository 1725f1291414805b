#include "study/report/schedule_text.h"

#include <bit>
#include <cstddef>
#include <nlohmann/json.hpp>

namespace stipple {
namespace {

using nlohmann::ordered_json;

ordered_json exposures_json(const ExposureSchedule& schedule, const ArrayPixel& pixel,
                            std::int64_t slots) {
    const int row = pixel.row % schedule.tile_rows();
    const int col = pixel.col % schedule.tile_cols();
    const auto exposures = schedule.exposures(row, col);
    const bool stores = schedule.charge_stores() == 2;
    ordered_json list = ordered_json::array();
    for (std::int64_t n = 0; n * schedule.period_slots() < slots; ++n)
        for (std::size_t i = 0; i < exposures.size(); ++i) {
            const std::int64_t begin = n * schedule.period_slots() + exposures[i].first_slot;
            if (begin >= slots) break;
            list.push_back({begin, stores ? schedule.store(row, col, i, n) : 0,
                            exposures[i].span_slots(), open_runs_json(exposures[i].open_slots)});
        }
    return list;
}

}  // namespace

ordered_json open_runs_json(std::uint64_t open_slots) {
    ordered_json runs = ordered_json::array();
    int first = 0;
    while (open_slots != 0) {
        const int closed = std::countr_zero(open_slots);
        open_slots >>= static_cast<unsigned>(closed);
        const int open = std::countr_one(open_slots);
        first += closed;
        runs.push_back({first, open});
        first += open;
        open_slots = open < kMaxExposureSlots ? open_slots >> static_cast<unsigned>(open) : 0;
    }
    return runs;
}

ordered_json lanes_json(const ExposureSchedule& schedule, FrameShape array, int count,
                        std::int64_t slots) {
    ordered_json lanes = ordered_json::array();
    for (const ArrayPixel& pixel : sample_pixels(schedule, array, count))
        lanes.push_back({{"row", pixel.row},
                         {"col", pixel.col},
                         {"exposures", exposures_json(schedule, pixel, slots)}});
    return lanes;
}

}  // namespace stipple
