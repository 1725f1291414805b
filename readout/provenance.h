#pragma once

#include <string>
#include <vector>

#include "io/footage_reader.h"
#include "readout/sensor_file.h"

namespace stipple {

/// Where light comes from and how its numbers were read: what a stream says of its footage.
struct FootageOrigin {
    std::string name = {};       ///< without folders
    std::string sha256 = {};     ///< of its files, one after the other; empty where there are none
    std::string recording = {};  ///< tells recordings of one camera apart; empty of files
    FootageOptions reading = {};
    double black_level_dn = 0;  ///< that was taken off a recording
};

/// The text that a stream carries of where it comes from (TOML, docs/stream_format.md): all that
/// decides its bytes. No time and no folder, so that the same run gives the same bytes.
[[nodiscard]] std::string provenance_of(const SensorSetup& setup, const FootageOrigin& footage);

/// The command that makes the same stream again, in the folder of its footage, where `provenance`
/// tells of one; else empty. Quoted for a shell and without control characters: the text
/// may be anybody's.
[[nodiscard]] std::string command_of(const std::string& provenance);

/// The keys of the section [timing] of the sensor that `provenance` tells of, as overrides of a
/// Config; none if it has none.
[[nodiscard]] std::vector<std::string> timing_settings(const std::string& provenance);

}  // namespace stipple
