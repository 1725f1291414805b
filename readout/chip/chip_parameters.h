#pragma once

#include <string>

#include "readout/program/sequencer_program.h"
#include "readout/sensor_file.h"

namespace stipple {

/// The sizes of a chip in gates: the parameters of the module stipple_chip (docs/rtl.md).
struct ChipParameters {
    int rows = 0;
    int cols = 0;
    int channels = 1;
    int columns_per_adc = 1;
    int group_rows = 1;
    int group_cols = 1;
    int tile_rows = 1;
    int tile_cols = 1;
    int pixel_bits = 1;
    int depth = 1;  ///< slots of a bank of the schedule memory
    int bit_depth = 8;
    int dark_rows = 1;   ///< max
    int word_bytes = 4;  ///< of the stream
    int words = 1024;    ///< of packets that wait: two of the longest
};

/// The sensor with an array of only setup.shape: row times stay, slots and the load of the exposure
/// code shorten in proportion to the rows. \throws InputError if the sensor has no timing or the
/// array does not hold that shape.
void cut_array(SensorSetup& setup);

/// The chip that runs this program as the sensor of `setup`, whose array is setup.shape. \throws
/// InputError naming the limit of the chip that the sensor or the schedule breaks.
[[nodiscard]] ChipParameters chip_parameters(const SensorSetup& setup,
                                             const SequencerProgram& program);

}  // namespace stipple
