#include "study/report/schedule_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

namespace stipple {
namespace {

/// The line of a charge store of a pixel.
std::string line_of(const ExposureSchedule& schedule, ArrayPixel pixel, int store, int slots) {
    const int row = pixel.row % schedule.tile_rows();
    const int col = pixel.col % schedule.tile_cols();
    const auto exposures = schedule.exposures(row, col);
    const std::int64_t period = schedule.period_slots();
    std::string line(static_cast<std::size_t>(slots), '.');
    for (std::int64_t n = -1; n * period < slots; ++n)
        for (std::size_t i = 0; i < exposures.size(); ++i) {
            if (schedule.store(row, col, i, n + 2) != store) continue;
            const Exposure& e = exposures[i];
            const char read = e.light_slots() < 10 ? static_cast<char>('0' + e.light_slots()) : '#';
            for (int age = 0; age < e.span_slots(); ++age) {
                const std::int64_t slot = n * period + e.first_slot + age;
                if (slot >= 0 && slot < slots && (e.open_slots >> age & 1U) != 0)
                    line[static_cast<std::size_t>(slot)] = age + 1 == e.span_slots() ? read : '-';
            }
        }
    return line;
}

/// The numbers of every fourth or, of many, every eighth slot, each above its slot.
std::string ruler(const std::string& title, int slots) {
    const int every = slots > 64 ? 8 : 4;
    std::string line = fmt::format("{:>12}  ", title);
    for (int slot = 0; slot < slots; slot += every) line += fmt::format("{:<{}}", slot, every);
    line.erase(line.find_last_not_of(' ') + 1);
    return line + '\n';
}

}  // namespace

nlohmann::ordered_json figures_json(const std::string& name, const ScheduleFigures& figures) {
    return {{"name", name},
            {"tile_rows", figures.tile_rows},
            {"tile_cols", figures.tile_cols},
            {"period_slots", figures.period_slots},
            {"compression_ratio", figures.compression_ratio},
            {"light_throughput", figures.light_throughput},
            {"min_exposures", figures.min_exposures},
            {"max_exposures", figures.max_exposures},
            {"min_due", figures.min_due},
            {"mean_due", figures.mean_due},
            {"max_due", figures.max_due},
            {"charge_stores", figures.charge_stores},
            {"code_memory_bits", figures.code_memory_bits}};
}

std::string figures_text(const std::string& name, const ScheduleFigures& figures) {
    const std::string exposures =
        figures.min_exposures == figures.max_exposures
            ? fmt::format("{}", figures.max_exposures)
            : fmt::format("{} to {}", figures.min_exposures, figures.max_exposures);
    return fmt::format(
        "{}: tile of {} x {} pixels, {} slots\n"
        "compression {:.4g} in steady state, light throughput {:.4g} %, {} exposure{} a pixel, {} "
        "charge store{}\n"
        "pixels read in a slot: {} to {}, mean {:.1f}; code memory {} bits",
        name, figures.tile_cols, figures.tile_rows, figures.period_slots, figures.compression_ratio,
        100 * figures.light_throughput, exposures, exposures == "1" ? "" : "s",
        figures.charge_stores, figures.charge_stores == 1 ? "" : "s", figures.min_due,
        figures.max_due, figures.mean_due, figures.code_memory_bits);
}

std::vector<ArrayPixel> sample_pixels(const ExposureSchedule& schedule, FrameShape array,
                                      int count) {
    const std::int64_t cols = std::min(schedule.tile_cols(), array.cols);
    const std::int64_t tile = std::min(schedule.tile_rows(), array.rows) * cols;
    std::vector<ArrayPixel> pixels;
    for (std::int64_t i = 0; i < count; ++i) {
        const std::int64_t in_tile = tile > count ? i * tile / count : i % tile;
        const std::int64_t tiles_right = tile > count ? 0 : i / tile;
        const std::int64_t col = in_tile % cols + tiles_right * cols;
        if (col < array.cols)
            pixels.push_back({static_cast<int>(in_tile / cols), static_cast<int>(col)});
    }
    return pixels;
}

std::string diagram_text(const ExposureSchedule& schedule, const std::vector<ArrayPixel>& pixels,
                         int slots) {
    const bool two = schedule.charge_stores() == 2;
    std::string text = ruler(two ? "pixel, store" : "pixel", slots);
    for (const ArrayPixel& pixel : pixels)
        for (int store = 0; store < (two ? 2 : 1); ++store) {
            std::string name = fmt::format("({}, {})", pixel.row, pixel.col);
            if (two) name = fmt::format("{} {}", store == 0 ? name : "", store + 1);
            text += fmt::format("{:>12}  {}\n", name, line_of(schedule, pixel, store, slots));
        }
    return text +
           "- open  . closed  1 to 9 read at its end, after so many open slots  # after more\n";
}

}  // namespace stipple
