#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "apps/arguments/run_options.h"
#include "apps/part_of_work.h"
#include "io/image_coding.h"
#include "io/video_coding.h"

namespace stipple {

/// Whether the samples are compared with the schedule of the header before decoding.
enum class CheckSchedule : std::uint8_t {
    kNo,
    kRefuseShift,  ///< samples that follow the schedule with a shift are an error
    kFixShift      ///< they are decoded with this shift
};

/// Of `DecodeArguments::calibration`: do not calibrate.
inline constexpr std::string_view kNoCalibration = "none";

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
    PartOfWork part;          ///< of the windows of the stream
    bool follow = false;      ///< the stream is still being written
    double timeout_s = 10;    ///< with `follow`: without growth
    std::string calibration;  ///< file of the chip's calibration, or "none"; empty: beside stream
    CheckSchedule check_schedule = CheckSchedule::kNo;
    VideoCoding video;   ///< of .mp4 and .mkv
    ImageCoding images;  ///< of folders and .tif
};

/// Decodes a stream to video and says how it went. \throws InputError, DeviceError, Interrupted.
void decode_file(const DecodeArguments& arguments, const RunOptions& run);

}  // namespace stipple
