#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "apps/arguments/command_line.h"
#include "capture/serve/frame_source.h"
#include "io/footage_reader.h"
#include "readout/sensor_file.h"

namespace stipple {

enum class ServedMode : std::uint8_t {
    kFrames,  ///< the frames as they are
    kCoded    ///< the samples of an emulated sensor
};

/// The source of `capture serve`.
struct ServedSourceChoice {
    std::string path;
    ServedMode mode = ServedMode::kFrames;
    std::optional<double> frames_hz;
    std::string format;  ///< of footage in mode frames; empty: Mono8
    FootageOptions reading;
    SensorChoice sensor;  ///< of mode coded
};

/// SOURCE and how it is served: `--mode`, `--frames-hz`, `--format`, and the arguments of footage
/// and sensor.
void add_served_source(Command& command, ServedSourceChoice& source);

/// Opens the source. \throws InputError naming the file or option that cannot be used.
[[nodiscard]] std::unique_ptr<FrameSource> open_served_source(const ServedSourceChoice& choice);

}  // namespace stipple
