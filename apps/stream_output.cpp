#include "apps/stream_output.h"

#include "apps/output/leftovers.h"
#include "readout/sensor_file.h"

namespace stipple {

StreamRecorder open_stream_output(const std::filesystem::path& file, const RunOptions& run,
                                  const SensorSetup& setup, const FootageOrigin& origin) {
    say_leftover(file);
    return StreamRecorder(file, setup,
                          {.force = run.force, .provenance = provenance_of(setup, origin)});
}

}  // namespace stipple
