#include "apps/stream_output.h"

#include <system_error>

#include "apps/output/leftovers.h"
#include "calibration/calibration_file.h"
#include "io/text_file.h"
#include "readout/emulator.h"
#include "readout/provenance.h"
#include "readout/sensor_file.h"
#include "session/stream_calibration.h"

namespace stipple {
namespace {

/// The bytes of a calibration of the chip of `setup`.
std::string bytes_of(const std::string& file, const SensorSetup& setup) {
    const auto bytes = encode_chip_calibration(
        read_calibration(file, stream_header_of(setup, provenance_of(setup, {}))));
    return {bytes.begin(), bytes.end()};
}

}  // namespace

StreamRecorder open_stream_output(const std::filesystem::path& file, const RunOptions& run,
                                  const SensorSetup& setup, const FootageOrigin& origin,
                                  const std::optional<Switches>& switches) {
    say_leftover(file);
    return StreamRecorder(
        file, setup,
        {.force = run.force,
         .may_switch = switches.has_value(),
         .provenance = provenance_of(setup, origin, switches.value_or(Switches{}))});
}

AttachedCalibration::AttachedCalibration(const std::string& file, std::filesystem::path stream,
                                         const SensorSetup& setup, const RunOptions& run)
    : bytes_(bytes_of(file, setup)) {
    std::error_code absent;
    stream.replace_extension(".stcal");
    if (!std::filesystem::equivalent(file, stream, absent)) output_.emplace(stream, run.force);
}

void AttachedCalibration::write() {
    if (output_) write_text(*output_, bytes_);
}

}  // namespace stipple
