#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "io/footage_reader.h"

namespace stipple {

struct SensorSetup;

/// The source of the light and the options of its reader, for the provenance of a stream.
struct FootageOrigin {
    std::string name = {};          ///< without folders
    std::string sha256 = {};        ///< of its files, concatenated; empty without files
    std::string recording = {};     ///< random, unique per run of a camera; empty for files
    std::string pixel_format = {};  ///< of the camera that replays footage; empty otherwise
    FootageOptions reading = {};
    double black_level_dn = 0;  ///< subtracted from the input
    std::string resample = {};  ///< method that made slots of frames; empty: a frame is a slot
};

/// The provenance in a stream header (TOML, docs/stream_format.md): everything that determines the
/// bytes of the stream. Without times and folders, so that the same run gives the same bytes.
/// `switches`: options `--switch` of `emulate`.
[[nodiscard]] std::string provenance_of(const SensorSetup& setup, const FootageOrigin& footage,
                                        const std::vector<std::string>& switches = {});

/// The command that makes the same stream again in the folder of its footage. Empty if there is
/// none: of light without files, and of a sensor or schedule made in code. Quoted for a shell and
/// without control characters, because `provenance` is not trusted.
[[nodiscard]] std::string command_of(const std::string& provenance);

/// The options of `emulate` that read footage so, each after a blank: " --luminance --bin 2".
/// Quoted for a shell.
[[nodiscard]] std::string options_of(const FootageOptions& reading);

/// The section [footage] of `provenance`, as TOML: the origin of the light. Empty if there is none.
[[nodiscard]] std::string footage_of(const std::string& provenance);

/// The keys of the section [timing] in `provenance`, as overrides of a Config; empty if there are
/// none.
[[nodiscard]] std::vector<std::string> timing_settings(const std::string& provenance);

/// The chip of a stream, as its provenance tells: an emulated one.
struct ChipOrigin {
    std::string name = {};                        ///< of the sensor; empty: not told
    std::optional<std::uint32_t> device_id = {};  ///< which chip of this sensor
    double prnu = 0;                              ///< as the keys of docs/physics.md
    double dsnu_e = 0;
    double column_noise_e = 0;
    double response_loss = 0;
};

[[nodiscard]] ChipOrigin chip_of(const std::string& provenance);

}  // namespace stipple
