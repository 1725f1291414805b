#include <array>
#include <string>
#include <string_view>

#include "core/config.h"
#include "core/error.h"
#include "core/geometry.h"
#include "core/named_value.h"
#include "readout/timing/readout_timing.h"

namespace stipple {
namespace {

constexpr std::string_view kSection = "timing.";
constexpr KeyRange kHz{1, 1e11};  ///< a tick of 10 ps
constexpr KeyRange kClocks{0, 1e8};
constexpr KeyRange kArray{1, kMaxFrameSide};  ///< rows or columns
constexpr KeyRange kRows{0, kMaxFrameSide};
constexpr KeyRange kLanes{0, ColumnAddressing::kMaxChannels};
constexpr KeyRange kEnergy{0, 1e12};
constexpr auto kRowTimings =
    std::to_array<NamedValue<RowTiming>>({{"overlapped", RowTiming::kOverlapped},
                                          {"sequential", RowTiming::kSequential},
                                          {"full_width", RowTiming::kFullWidth}});

void read_transfer(const KeyReader& read, ReadoutTiming& timing) {
    read({"clocks_per_column", kClocks, "clocks", "transfer time of a column of a channel"},
         timing.clocks_per_column);
    read({"io_clocks", kClocks, "clocks", "transfer time of each row beside its columns"},
         timing.io_clocks);
    read({"row_table_cols", kRows, "columns", "widths of the table of transfer times, rising"},
         timing.row_table_cols);
    read({"row_table_clocks", kClocks, "clocks", "transfer times of the table, rising"},
         timing.row_table_clocks);
    read({"link_lanes", kLanes, "", "of the link; 0: as fast as the channels"}, timing.link_lanes);
    read({"link_bps", kHz, "bits/s", "rate of a lane"}, timing.link_bps);
}

void read_conversion(const KeyReader& read, ReadoutTiming& timing) {
    read({"rot_clocks", kClocks, "clocks", "row overhead time: selection and sampling"},
         timing.rot_clocks);
    read({"settle_clocks", kClocks, "clocks", "settling times to choose from, rising"},
         timing.settle_clocks);
    read({"settle_margin", {-65535, 65535}, "columns", "of the choice of the settling time"},
         timing.settle_margin);
    read({"adc_clocks", kClocks, "clocks", "conversion time"}, timing.adc_clocks);
    read({"columns_per_adc", kArray, "", "columns that share an ADC"}, timing.columns_per_adc);
    read({"adc_skip", {}, "", "whether a shared ADC converts only what is transferred"},
         timing.adc_skip);
}

void read_frame(const KeyReader& read, ReadoutTiming& timing) {
    read({"blanking_clocks", kClocks, "clocks", "blanking after each row"}, timing.blanking_clocks);
    read({"skip_row_clocks", kClocks, "clocks", "time to step over a row that is not read"},
         timing.skip_row_clocks);
    read({"dark_rows", kRows, "rows", "dark rows, read in full before the others"},
         timing.dark_rows);
    read({"overhead_rows", kRows, "rows", "row times without samples, before the rows"},
         timing.overhead_rows);
    read({"overhead_clocks", kClocks, "clocks", "overhead of each readout"},
         timing.overhead_clocks);
    read({"code_load_clocks", kClocks, "clocks", "time to load the exposure code of the array"},
         timing.code_load_clocks);
}

void read_energy(const KeyReader& read, ReadoutTiming& timing) {
    read({"row_select_pj", kEnergy, "pJ", "energy to select a row"}, timing.row_select_pj);
    read({"conversion_pj", kEnergy, "pJ", "energy of a conversion of 10 bits"},
         timing.conversion_pj);
    read({"link_bit_pj", kEnergy, "pJ", "energy of a bit on the link"}, timing.link_bit_pj);
    read({"code_bit_pj", kEnergy, "pJ", "energy of a bit of exposure code"}, timing.code_bit_pj);
}

}  // namespace

std::optional<ReadoutTiming> read_timing(Config& config, int bits_per_sample) {
    const KeyReader read(config, std::string(kSection));
    ReadoutTiming timing;
    read({"clock_hz", kHz, "Hz", "clock of the readout"}, timing.clock_hz);
    read(
        {"row_timing", {}, "", "how conversion and transfer share the time", kNamesOf<kRowTimings>},
        timing.row_timing);
    read({"rows", kArray, "pixels", "rows of the array"}, timing.rows);
    read({"cols", kArray, "pixels", "columns of the array"}, timing.cols);
    read({"exposes_while_reading", {}, "", "whether pixels expose while the chip reads"},
         timing.exposes_while_reading);
    read_addressing(read, timing.addressing);
    read_transfer(read, timing);
    read_conversion(read, timing);
    read_frame(read, timing);
    read_energy(read, timing);
    read({"hypothetical", {}, "", "how the commercial chip differs"}, timing.hypothetical);
    if (timing == ReadoutTiming{}) return {};
    for (const auto& [key, missing] : {std::pair{"clock_hz", timing.clock_hz == 0},
                                       {"rows", timing.rows == 0},
                                       {"cols", timing.cols == 0}})
        if (missing)
            throw InputError(config.where(std::string(kSection) + key),
                             "is missing; the section [timing] needs it");
    timing.bits_per_sample = bits_per_sample;
    validate(timing, config.text({"name"}, "?"));
    return timing;
}

}  // namespace stipple
