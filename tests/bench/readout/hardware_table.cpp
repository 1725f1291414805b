// The tables of docs/hardware_schedules.md: the speed-up by schedules on each sensor with a
// section [timing], what they cost in quality, and the same for groups of growing size. Many
// minutes long, so the tests do not run it. `bench_hardware_table groups FILE.svg` also draws the
// chart of groups.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <utility>
#include <vector>

#include "core/config.h"
#include "readout/schedules/hardware_tiled.h"
#include "readout/schedules/tiled_schedule.h"
#include "readout/timing/readout_rate.h"
#include "study/report/chart.h"
#include "tests/pipeline/clip.h"
#include "tests/readout/timing/sensor_timing.h"

namespace stipple {
namespace {

constexpr int kSide = 128;        // pixels of the middle of each clip that are decoded
constexpr int kRandomRows = 256;  // of a random schedule over an array, repeated below
constexpr int kRandomSide = 120;  // groups of a tile of random groups

/// Mean PSNR of some decoded clips, in dB, linear and after 1/2.2.
struct Quality {
    double linear = 0;
    double gamma = 0;

    Quality operator-(const Quality& other) const {
        return {linear - other.linear, gamma - other.gamma};
    }
    [[nodiscard]] std::string text() const { return fmt::format("{:+.2f}/{:+.2f}", linear, gamma); }
};

FluxVideo middle_of(const FluxVideo& clip) {
    FluxVideo middle(clip.slots(), {.rows = kSide, .cols = kSide, .planes = 1});
    const int first_row = (clip.shape().rows - kSide) / 2;
    const int first_col = (clip.shape().cols - kSide) / 2;
    for (int slot = 0; slot < clip.slots(); ++slot)
        for (int row = 0; row < kSide; ++row)
            for (int col = 0; col < kSide; ++col)
                middle.plane(slot, 0)(row, col) =
                    std::as_const(clip).plane(slot, 0)(first_row + row, first_col + col);
    return middle;
}

std::vector<FluxVideo> read_clips() {
    std::vector<FluxVideo> clips;
    for (const char* name : {"mouse250_a", "mouse250_b", "nat30_blocks", "nat30_coffee", "hdr_desk",
                             "hdr_desk_fg", "hdr_stilllife"})
        if (const auto clip = luminance_clip(name)) clips.push_back(middle_of(*clip));
    return clips;
}

/// A way to make schedules: by `name`, for an array of so many columns.
struct Maker {
    std::string name;
    HardwareTile tile = {};

    [[nodiscard]] ExposureSchedule make(FrameShape shape, std::uint64_t seed) const {
        if (name == "random")
            return random_schedule(std::min(shape.rows, kRandomRows), shape.cols,
                                   kPaperExposureSlots, seed);
        if (name == "tiled") return tiled_schedule(16, 16, kPaperExposureSlots, seed);
        return hardware_tiled_schedule(tile, kPaperExposureSlots, seed);
    }
};

Maker random_groups(HardwareTile tile) {
    const bool groups = tile.addressing.kind == ColumnAddressing::Kind::kGroup;
    tile.arrangement = TileArrangement::kRandom;
    tile.tile_rows = kRandomSide * (groups ? tile.addressing.group_rows : 1);
    tile.tile_cols = kRandomSide * (groups ? tile.addressing.group_cols : 1);
    return {"random groups", tile};
}

/// Decodes clips, each schedule once.
class Trials {
  public:
    /// Each schedule is made and recorded with the seeds 1 .. `seeds`.
    explicit Trials(std::uint64_t seeds) : seeds_(seeds) {}

    Quality quality_of(const Maker& maker) {
        const ExposureSchedule first = maker.make(clips_.front().shape(), 1);
        for (const auto& [schedule, quality] : known_)
            if (schedule == first) return quality;
        Quality sum;
        for (std::uint64_t seed = 1; seed <= seeds_; ++seed)
            for (const FluxVideo& clip : clips_) {
                const NamedSchedule schedule{maker.name, {}, maker.make(clip.shape(), seed)};
                const VideoQuality quality =
                    stipple::quality_of(clip, schedule, seed, DecodeMethod::kFast);
                sum.linear += quality.psnr_db;
                sum.gamma += quality.psnr_gamma_db;
            }
        const auto trials = static_cast<double>(seeds_ * clips_.size());
        known_.emplace_back(first, Quality{sum.linear / trials, sum.gamma / trials});
        return known_.back().second;
    }

  private:
    std::uint64_t seeds_;
    std::vector<FluxVideo> clips_ = read_clips();
    std::vector<std::pair<ExposureSchedule, Quality>> known_;
};

/// One sensor with one kind of addressing.
void print_sensor(const std::string& name, ColumnAddressing::Kind kind, Trials& trials) {
    ReadoutTiming timing = sensor_timing(name);
    timing.addressing.kind = kind;
    const bool groups = kind == ColumnAddressing::Kind::kGroup;
    const FrameShape shape{.rows = timing.rows, .cols = timing.cols, .planes = 1};
    const HardwareTile tile{.addressing = timing.addressing, .array_cols = timing.cols};
    std::vector<Maker> makers{{"random"}, {"tiled"}};
    if (groups) makers.push_back(random_groups(tile));
    makers.push_back({"hardware_tiled", tile});
    const Quality random = trials.quality_of(makers.front());
    for (const Maker& maker : makers) {
        const ReadoutRate rate = rate_of(timing, maker.make(shape, 1), shape, 0);
        const auto addressing = groups ? fmt::format("group {}x{}", timing.addressing.group_cols,
                                                     timing.addressing.group_rows)
                                       : fmt::format("skip_channel {}", timing.addressing.channels);
        fmt::print("| {} | {} | {} | {:.2f} | {:.2f} | {:.0f} % | {} |\n", name, addressing,
                   maker.name, rate.speedup, rate.balanced_speedup,
                   100 * rate.speedup / rate.balanced_speedup,
                   (trials.quality_of(maker) - random).text());
        std::fflush(stdout);
    }
}

void print_sensors() {
    Trials trials(1);
    fmt::print(
        "| sensor | addressing | schedule | speed-up | bound | of bound | dB to `random` |\n"
        "|---|---|---|---|---|---|---|\n");
    for (const char* name :
         {"lux1310", "lux2100", "imx273", "sp5000", "imx296", "vita", "plc720", "cmv4000"})
        for (const auto kind :
             {ColumnAddressing::Kind::kSkipChannel, ColumnAddressing::Kind::kGroup})
            print_sensor(name, kind, trials);
}

/// Points of the chart: speed-up, and dB of random and of arranged groups.
struct Point {
    double speedup;
    double random_db;
    double arranged_db;
    std::string size;
};

/// Group sizes on a LUX1310 whose groups go from single pixels up.
std::vector<Point> print_groups() {
    Trials trials(2);
    fmt::print(
        "\n| group | speed-up, random groups | speed-up, hardware_tiled | random groups dB | "
        "hardware_tiled dB | difference |\n|---|---|---|---|---|---|\n");
    std::vector<Point> points;
    ReadoutTiming timing = sensor_timing("lux1310");
    const FrameShape shape{.rows = timing.rows, .cols = timing.cols, .planes = 1};
    const Quality reference = trials.quality_of({"random"});
    for (const auto& [cols, rows] : {std::pair{1, 1}, {2, 2}, {4, 1}, {8, 1}, {16, 1}, {16, 2}}) {
        timing.addressing.kind = ColumnAddressing::Kind::kGroup;
        timing.addressing.group_cols = cols;
        timing.addressing.group_rows = rows;
        const Maker arranged{"hardware_tiled",
                             {.addressing = timing.addressing, .array_cols = timing.cols}};
        const Maker random = random_groups(arranged.tile);
        const Quality random_quality = trials.quality_of(random);
        const Quality quality = trials.quality_of(arranged);
        const double random_speedup = rate_of(timing, random.make(shape, 1), shape, 0).speedup;
        const double speedup = rate_of(timing, arranged.make(shape, 1), shape, 0).speedup;
        fmt::print("| {}x{} | {:.2f} | {:.2f} | {} | {} | {} |\n", cols, rows, random_speedup,
                   speedup, (random_quality - reference).text(), (quality - reference).text(),
                   (quality - random_quality).text());
        std::fflush(stdout);
        points.push_back({speedup, (random_quality - reference).linear,
                          (quality - reference).linear, fmt::format("{}x{}", cols, rows)});
    }
    return points;
}

void draw(const std::vector<Point>& points, const std::string& file) {
    std::string data;
    for (std::size_t i = 0; i < points.size(); ++i)
        data += fmt::format("{} {} {} \"{}\"\n", i, points[i].random_db, points[i].arranged_db,
                            points[i].size);
    std::ofstream(file, std::ios::binary) << draw_chart(
        std::filesystem::path(file).extension().string(), {.width = 720, .height = 420},
        "$points << END\n" + data +
            "END\n"
            "set xlabel 'group, columns x rows'\n"
            "set ylabel 'decoded PSNR against random, dB'\n"
            "set grid ytics\nset key bottom left\nset offsets 0.3, 0.3, 0.3, 0.3\n"
            "plot $points using 1:2:xtic(4) with linespoints pt 7 title 'random groups', "
            "$points using 1:3 with linespoints pt 7 title 'hardware_tiled'\n");
}

}  // namespace
}  // namespace stipple

int main(int arguments, char** values) {
    const std::string table = arguments > 1 ? values[1] : "";
    if (table == "groups") {
        const auto points = stipple::print_groups();
        if (arguments > 2) stipple::draw(points, values[2]);
    } else if (table == "sensors") {
        stipple::print_sensors();
    } else {
        fmt::print(stderr, "usage: bench_hardware_table groups [FILE.svg] | sensors\n");
        return 2;
    }
}
