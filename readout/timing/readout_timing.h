#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/config.h"
#include "readout/column_addressing.h"

namespace stipple {

/// Max clocks of a readout or a slot.
inline constexpr std::int64_t kMaxReadoutClocks = std::int64_t{1} << 40U;

/// Bits of a conversion whose energy is `conversion_pj`.
inline constexpr int kConversionBits = 10;

/// Overlap of the conversion of a row and the transfer of a row to the link.
enum class RowTiming : std::uint8_t {
    kOverlapped,  ///< row i is transferred while row i + 1 is converted
    kSequential,  ///< a row is selected and converted, then transferred, then the next one begins
    kFullWidth    ///< as kOverlapped, but a transfer takes the time of all columns
};

/// The readout timing of a column-parallel sensor, a table of whole clocks
/// (docs/readout_timing.md). Rows and columns are those of the array; a window is its first rows
/// and columns.
///
/// Not modelled: jitter, clock domains, register writes between frames, power states.
struct ReadoutTiming {
    std::int64_t clock_hz = 0;
    RowTiming row_timing = RowTiming::kOverlapped;
    int rows = 0;
    int cols = 0;
    ColumnAddressing addressing;

    /// True if pixels expose while others wait for their readout (pipelined global shutter). If
    /// not, all pixels are closed while the chip reads.
    bool exposes_while_reading = true;

    // Transfer of a row: set by the busiest channel, or by the table.
    int clocks_per_column = 1;  ///< of a channel
    int io_clocks = 0;          ///< of each row, beside its columns
    /// If not empty, a transfer takes `row_table_clocks[i]` with the smallest `row_table_cols[i]`
    /// that is not less than the columns read. Both lists rise.
    std::vector<int> row_table_cols;
    std::vector<int> row_table_clocks;
    int link_lanes = 0;         ///< 0: the link is as fast as the channels
    std::int64_t link_bps = 0;  ///< bits per second of a lane
    int bits_per_sample = 8;    ///< on the link

    // Conversion of a row.
    int rot_clocks = 0;  ///< row overhead time: selection and sampling
    /// Settling times, rising. The longest one not above columns per channel + `settle_margin` is
    /// used, else the shortest. Empty: no settling.
    std::vector<int> settle_clocks;
    int settle_margin = 0;
    int adc_clocks = 0;       ///< of one conversion
    int columns_per_adc = 1;  ///< converted one after another; column c belongs to c mod (ADCs)
    bool adc_skip = false;    ///< a shared ADC converts only the columns that are transferred

    // Around the rows.
    int blanking_clocks = 0;           ///< after each row; neither ADC nor link works
    int skip_row_clocks = 0;           ///< to skip a row
    int dark_rows = 0;                 ///< read in full before the first row, no samples
    int overhead_rows = 0;             ///< row times at full width before the rows, without samples
    std::int64_t overhead_clocks = 0;  ///< of each readout, before all rows
    std::int64_t code_load_clocks = 0;  ///< to load the array's exposure code, beside the readout

    // Energy of one operation.
    double row_select_pj = 0;
    double conversion_pj = 0;  ///< of `kConversionBits`
    double link_bit_pj = 0;
    double code_bit_pj = 0;  ///< a bit of exposure code, one per pixel and slot

    /// Differences from the commercial chip, informative; empty: none.
    std::string hypothetical = {};

    [[nodiscard]] int adcs() const { return cols / columns_per_adc; }
    bool operator==(const ReadoutTiming&) const = default;
};

/// \throws InputError naming the sensor, the violated constraint, and the remedy.
void validate(const ReadoutTiming& timing, std::string_view sensor);

/// The section [timing] of a sensor file; nothing without the section. The section has no key for
/// `bits_per_sample`. \throws InputError naming file, line and key of a value out of range or a
/// missing clock, and as `validate`.
[[nodiscard]] std::optional<ReadoutTiming> read_timing(Config& config, int bits_per_sample);

/// Clocks of the settling time if each channel reads `channel_columns`; 0 without settling.
[[nodiscard]] int settle_clocks(const ReadoutTiming& timing, int channel_columns) noexcept;

/// Clocks to transfer a row whose busiest channel reads `channel_columns`.
/// Precondition: 0 < channel_columns <= cols / channels.
[[nodiscard]] std::int64_t transfer_clocks(const ReadoutTiming& timing,
                                           int channel_columns) noexcept;

/// Clocks from the selection of a row to the end of its conversions; `conversions`: of the busiest
/// ADC.
[[nodiscard]] std::int64_t convert_clocks(const ReadoutTiming& timing, int settle,
                                          int conversions) noexcept;

/// Clocks to load the exposure code of `rows` rows, one after the other.
[[nodiscard]] std::int64_t code_load_clocks(const ReadoutTiming& timing, int rows) noexcept;

/// Energy of one conversion. It doubles with each bit, so the energy per quantisation step is
/// constant (Walden, "Analog-to-digital converter survey and analysis", IEEE JSAC
/// 17(4), 1999).
[[nodiscard]] double conversion_energy_pj(const ReadoutTiming& timing) noexcept;

/// Row time if all rows are equal.
[[nodiscard]] std::int64_t row_clocks(const ReadoutTiming& timing, std::int64_t convert,
                                      std::int64_t transfer) noexcept;

}  // namespace stipple
