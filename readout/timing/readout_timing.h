#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/config.h"
#include "readout/timing/column_addressing.h"

namespace stipple {

/// Clocks of a readout or a slot are at most that many.
inline constexpr std::int64_t kMaxReadoutClocks = std::int64_t{1} << 40U;

/// Bits of a conversion whose energy is `conversion_pj`.
inline constexpr int kConversionBits = 10;

/// How the conversion of a row and the transfer of a row to the link share the time.
enum class RowTiming : std::uint8_t {
    kOverlapped,  ///< row i is transferred while row i + 1 is converted
    kSequential,  ///< a row is selected and converted, then transferred, then the next one begins
    kFullWidth    ///< as kOverlapped, but a transfer takes as long as that of all columns
};

/// The readout clockwork of a column-parallel sensor, a table of whole clocks
/// (docs/readout_timing.md). Rows and columns are those of the array; what is read of them are
/// the first ones.
///
/// Not modelled: jitter, clock domains, register writes between frames, power states.
struct ReadoutTiming {
    std::int64_t clock_hz = 0;
    RowTiming row_timing = RowTiming::kOverlapped;
    int rows = 0;
    int cols = 0;
    ColumnAddressing addressing;

    // Transfer of a row: the channel with the most columns sets it, or the table.
    int clocks_per_column = 1;  ///< of a channel
    int io_clocks = 0;          ///< of each row, beside its columns
    /// Where not empty, a transfer takes `row_table_clocks[i]`, i the smallest width
    /// `row_table_cols[i]` that holds what is read. Both rise.
    std::vector<int> row_table_cols;
    std::vector<int> row_table_clocks;
    int link_lanes = 0;         ///< 0: the link is as fast as the channels
    std::int64_t link_bps = 0;  ///< bits per second of a lane
    int bits_per_sample = 8;    ///< on the link

    // Conversion of a row.
    int rot_clocks = 0;  ///< row overhead time: selection and sampling
    /// Times of settling to choose from, rising: the longest one not above the columns per channel
    /// + `settle_margin`, else the shortest. Empty: none.
    std::vector<int> settle_clocks;
    int settle_margin = 0;
    int adc_clocks = 0;       ///< of one conversion
    int columns_per_adc = 1;  ///< converted one after another; column c belongs to c mod (ADCs)
    bool adc_skip = false;    ///< a shared ADC converts only the columns that are transferred

    // Around the rows.
    int blanking_clocks = 0;  ///< after each row; neither ADC nor link works
    int skip_row_clocks = 0;  ///< to step over a row of which nothing is read
    int dark_rows = 0;        ///< read in full before the first row, no samples
    int overhead_rows = 0;    ///< row times at full width before the rows; they carry nothing
    std::int64_t overhead_clocks = 0;   ///< of each readout, before all rows
    std::int64_t code_load_clocks = 0;  ///< to load the array's exposure code, beside the readout

    // Energy of one operation.
    double row_select_pj = 0;
    double conversion_pj = 0;  ///< of `kConversionBits`
    double link_bit_pj = 0;
    double code_bit_pj = 0;  ///< a bit of exposure code, one per pixel and slot

    /// How the chip that is sold differs, for people; empty: it does not.
    std::string hypothetical = {};

    [[nodiscard]] int adcs() const { return cols / columns_per_adc; }
    bool operator==(const ReadoutTiming&) const = default;
};

/// \throws InputError naming the sensor, the constraint that is broken, and what to do.
void validate(const ReadoutTiming& timing, std::string_view sensor);

/// The section [timing] of a sensor file; none if there is none. The section has no key for
/// `bits_per_sample`. \throws InputError naming file, line and key of a value out of range or a
/// missing clock, and as `validate`.
[[nodiscard]] std::optional<ReadoutTiming> read_timing(Config& config, int bits_per_sample);

/// Clocks of the chosen settling time when each channel reads `channel_columns`; 0 without choices.
[[nodiscard]] int settle_clocks(const ReadoutTiming& timing, int channel_columns) noexcept;

/// Clocks to transfer a row of which the busiest channel reads `channel_columns`.
/// Precondition: 0 < channel_columns <= cols / channels.
[[nodiscard]] std::int64_t transfer_clocks(const ReadoutTiming& timing,
                                           int channel_columns) noexcept;

/// Clocks from the selection of a row to the end of its conversions, `conversions` in the busiest
/// ADC.
[[nodiscard]] std::int64_t convert_clocks(const ReadoutTiming& timing, int settle,
                                          int conversions) noexcept;

/// Clocks to load the exposure code of `rows` rows, one after the other.
[[nodiscard]] std::int64_t code_load_clocks(const ReadoutTiming& timing, int rows) noexcept;

/// Energy of one conversion: twice as much for each bit, so that the energy of a step of the
/// converter is constant (Walden, "Analog-to-digital converter survey and analysis", IEEE JSAC
/// 17(4), 1999).
[[nodiscard]] double conversion_energy_pj(const ReadoutTiming& timing) noexcept;

/// From one row to the next when all rows are alike.
[[nodiscard]] std::int64_t row_clocks(const ReadoutTiming& timing, std::int64_t convert,
                                      std::int64_t transfer) noexcept;

}  // namespace stipple
