#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "apps/arguments/run_options.h"
#include "apps/part_of_work.h"
#include "decoder/schedule_check/schedule_check.h"
#include "io/frame_coding.h"
#include "session/decode_session.h"
#include "stream/stream_reader.h"

namespace stipple {

/// Whether the samples are compared with the schedule of the header before decoding.
enum class CheckSchedule : std::uint8_t {
    kNo,
    kRefuseShift,  ///< samples that follow the schedule with a shift are an error
    kFixShift      ///< they are decoded with this shift
};

/// The arguments of `stipple decode`.
struct DecodeArguments {
    std::string stream;
    std::string output;
    std::string method = "best";
    std::string options;  ///< file of the method's options; empty: none
    std::vector<std::string> settings;
    std::string stages;  ///< folder; empty: none
    bool strict = false;
    bool fill_gaps = false;
    std::int64_t until = 0;   ///< frames wanted; 0: all
    Shard part;               ///< of the windows of the stream
    bool follow = false;      ///< the stream is still being written
    double timeout_s = 10;    ///< with `follow`: without growth
    std::string calibration;  ///< as calibration_choice
    CheckSchedule check_schedule = CheckSchedule::kNo;
    VideoCoding video;   ///< of .mp4 and .mkv
    ImageCoding images;  ///< of folders and .tif
};

/// \throws InputError as read_decode_setup, or if the method has no stages to keep.
[[nodiscard]] DecodeSetup setup_of(const DecodeArguments& arguments);

/// The name of its file, or null.
[[nodiscard]] nlohmann::ordered_json calibration_json(const DecodeArguments& arguments);

/// For a line of results: ", calibrated by FILE"; empty without calibration.
[[nodiscard]] std::string calibrated_text(const DecodeArguments& arguments);

/// What packets of a wrong size may mean; empty without one.
[[nodiscard]] std::string_view schedule_hint(const StreamReport& report);

/// The most memory of this process that has lain in RAM at a time.
[[nodiscard]] std::uint64_t peak_memory_bytes();

/// Decodes a stream to video and says how it went. \throws InputError, DeviceError, Interrupted.
void decode_file(const DecodeArguments& arguments, const RunOptions& run);

/// Decodes the windows of `arguments.part` that the folder `arguments.output` lacks (with `force`
/// all of the part). The parts have equal numbers of windows, except for one.
/// \throws InputError, DeviceError, Interrupted; complete windows are kept.
void decode_part(const DecodeArguments& arguments, const RunOptions& run);

/// Finds out whether a stream follows the schedule in its header, and says so. `reader` as for
/// check_schedule. \throws InputError if it follows another one, unless that is a shift that the
/// arguments want to be decoded with; if the stream cannot be read a second time.
[[nodiscard]] ScheduleCheck checked_schedule(StreamReader& reader, const DecodeArguments& arguments,
                                             const RunOptions& run);

/// The JSON key `schedule_check`.
[[nodiscard]] nlohmann::ordered_json check_json(const ScheduleCheck& check);

}  // namespace stipple
