#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

#include "apps/decode_file.h"
#include "decoder/decode_options.h"
#include "stream/stream_reader.h"

namespace stipple {

/// A method with its options.
struct DecodeSetup {
    DecodeOptions options;
    std::string given;  ///< options that the user gave, lines of TOML sorted by key
};

/// \throws InputError as read_decode_options, or if the method has no stages to keep.
[[nodiscard]] DecodeSetup read_decode_setup(const DecodeArguments& arguments);

/// The calibration file of a stream: the one that is given, or the one beside the stream. Empty
/// without one, and of "none".
[[nodiscard]] std::string calibration_file(const DecodeArguments& arguments);

/// Uses the calibration of the chip, or warns what it costs that there is none.
/// \throws InputError as read_calibration.
void calibrate(StreamReader& reader, const DecodeArguments& arguments);

/// The name of its file, or null.
[[nodiscard]] nlohmann::ordered_json calibration_json(const DecodeArguments& arguments);

/// For a line of results: ", calibrated by FILE"; empty without calibration.
[[nodiscard]] std::string calibrated_text(const DecodeArguments& arguments);

/// What packets of a wrong size may mean; empty without one.
[[nodiscard]] std::string_view schedule_hint(const StreamReport& report);

/// The most memory of this process that has lain in RAM at a time.
[[nodiscard]] std::uint64_t peak_memory_bytes();

}  // namespace stipple
