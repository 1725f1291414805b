#include <fmt/format.h>

#include <string>

#include "core/error.h"
#include "readout/timing/readout_timing.h"

namespace stipple {
namespace {

constexpr std::int64_t kMaxClockHz = 100'000'000'000;  ///< a tick of 10 ps
constexpr int kMaxClocks = 100'000'000;
constexpr int kMaxSide = 65535;
constexpr int kMaxChannels = 4096;
constexpr double kMaxPicojoules = 1e12;

/// Keys of one section of a config.
class Section {
  public:
    explicit Section(Config& config) : config_(config) {}

    int integer(const char* key, int fallback, int least, int most) {
        return static_cast<int>(config_.integer(name(key), fallback, least, most));
    }
    std::int64_t wide(const char* key, std::int64_t fallback, std::int64_t most) {
        return config_.integer(name(key), fallback, 1, most);
    }
    int clocks(const char* key, int fallback) { return integer(key, fallback, 0, kMaxClocks); }
    std::vector<int> list(const char* key, int most) {
        return config_.integers(name(key), {}, 0, most);
    }
    double picojoules(const char* key) { return config_.number(name(key), 0, 0, kMaxPicojoules); }
    std::string choice(const char* key, const char* fallback,
                       const std::vector<std::string>& choices) {
        return config_.choice(name(key), fallback, choices);
    }
    bool boolean(const char* key, bool fallback) { return config_.boolean(name(key), fallback); }
    std::string text(const char* key) { return config_.text(name(key), ""); }
    [[nodiscard]] static std::string name(const char* key) { return fmt::format("timing.{}", key); }

  private:
    Config& config_;
};

RowTiming row_timing_of(const std::string& name) {
    if (name == "sequential") return RowTiming::kSequential;
    return name == "full_width" ? RowTiming::kFullWidth : RowTiming::kOverlapped;
}

void read_addressing(Section& section, ColumnAddressing& addressing) {
    const std::string kind =
        section.choice("addressing", "skip_channel", {"skip_channel", "group"});
    addressing.kind =
        kind == "group" ? ColumnAddressing::Kind::kGroup : ColumnAddressing::Kind::kSkipChannel;
    addressing.channels = section.integer("channels", addressing.channels, 1, kMaxChannels);
    addressing.group_cols = section.integer("group_cols", addressing.group_cols, 1, kMaxSide);
    addressing.group_rows = section.integer("group_rows", addressing.group_rows, 1, kMaxSide);
}

void read_transfer(Section& section, ReadoutTiming& timing) {
    timing.clocks_per_column = section.clocks("clocks_per_column", timing.clocks_per_column);
    timing.io_clocks = section.clocks("io_clocks", timing.io_clocks);
    timing.row_table_cols = section.list("row_table_cols", kMaxSide);
    timing.row_table_clocks = section.list("row_table_clocks", kMaxClocks);
    timing.link_lanes = section.integer("link_lanes", timing.link_lanes, 0, kMaxChannels);
    timing.link_bps = section.wide("link_bps", timing.link_bps, kMaxClockHz);
}

void read_conversion(Section& section, ReadoutTiming& timing) {
    timing.rot_clocks = section.clocks("rot_clocks", timing.rot_clocks);
    timing.settle_clocks = section.list("settle_clocks", kMaxClocks);
    timing.settle_margin =
        section.integer("settle_margin", timing.settle_margin, -kMaxSide, kMaxSide);
    timing.adc_clocks = section.clocks("adc_clocks", timing.adc_clocks);
    timing.columns_per_adc =
        section.integer("columns_per_adc", timing.columns_per_adc, 1, kMaxSide);
    timing.adc_skip = section.boolean("adc_skip", timing.adc_skip);
}

void read_frame(Section& section, ReadoutTiming& timing) {
    timing.blanking_clocks = section.clocks("blanking_clocks", timing.blanking_clocks);
    timing.skip_row_clocks = section.clocks("skip_row_clocks", timing.skip_row_clocks);
    timing.dark_rows = section.integer("dark_rows", timing.dark_rows, 0, kMaxSide);
    timing.overhead_rows = section.integer("overhead_rows", timing.overhead_rows, 0, kMaxSide);
    timing.overhead_clocks = section.clocks("overhead_clocks", 0);
    timing.code_load_clocks = section.clocks("code_load_clocks", 0);
}

}  // namespace

std::optional<ReadoutTiming> read_timing(Config& config, int bits_per_sample) {
    Section section(config);
    ReadoutTiming timing;
    timing.clock_hz = section.wide("clock_hz", timing.clock_hz, kMaxClockHz);
    timing.row_timing = row_timing_of(
        section.choice("row_timing", "overlapped", {"overlapped", "sequential", "full_width"}));
    timing.rows = section.integer("rows", timing.rows, 1, kMaxSide);
    timing.cols = section.integer("cols", timing.cols, 1, kMaxSide);
    read_addressing(section, timing.addressing);
    read_transfer(section, timing);
    read_conversion(section, timing);
    read_frame(section, timing);
    timing.row_select_pj = section.picojoules("row_select_pj");
    timing.conversion_pj = section.picojoules("conversion_pj");
    timing.link_bit_pj = section.picojoules("link_bit_pj");
    timing.code_bit_pj = section.picojoules("code_bit_pj");
    timing.hypothetical = section.text("hypothetical");
    if (timing == ReadoutTiming{}) return {};
    for (const auto& [key, missing] : {std::pair{"clock_hz", timing.clock_hz == 0},
                                       {"rows", timing.rows == 0},
                                       {"cols", timing.cols == 0}})
        if (missing)
            throw InputError(config.place(Section::name(key)),
                             "is missing; the section [timing] needs it");
    timing.bits_per_sample = bits_per_sample;
    validate(timing, config.text("name", "?"));
    return timing;
}

}  // namespace stipple
