#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <string_view>

namespace stipple {

/// The names that an output may have: any, or those with one of the extensions.
struct OutputName {
    std::string_view rule = {};  ///< as in "a diagram is a .png or a .svg"; empty: any name
    std::array<std::string_view, 6> extensions = {};  ///< in lower case; names may be in upper case
    bool may_have_none = true;
    bool may_be_pipe = false;  ///< "-", standard output
};

/// True for "-" and for a named pipe.
[[nodiscard]] bool is_pipe(const std::filesystem::path& output);

/// What is wrong with `file` as a name of `name`, or an empty text. An existing folder, pipe or
/// device may have any name.
[[nodiscard]] std::string name_problem(const std::filesystem::path& file, const OutputName& name);

constexpr OutputName kStreamName{"a sample stream is a .stipple, or has a name without extension",
                                 {".stipple"}};
constexpr OutputName kRecordingName{"a recording is a .strec, or has a name without extension",
                                    {".strec"}};
constexpr OutputName kRecoveredName{
    "a stream is a .stipple, a recording a .strec, or either has a name without extension",
    {".stipple", ".strec"}};
constexpr OutputName kVideoName{
    "a video is a .npy, .mp4, .mkv, .y4m or .tif, or by a name without extension a folder of "
    "images",
    {".npy", ".mp4", ".mkv", ".y4m", ".tif", ".tiff"},
    true,
    true};
constexpr OutputName kDifferenceName{
    "a difference is a .png or a .npy, or by a name without extension a folder of EXR files",
    {".png", ".npy"}};
constexpr OutputName kTableName{"a table is a .csv, or has a name without extension", {".csv"}};
constexpr OutputName kPreviewName{"a preview is a .png or a .npy", {".png", ".npy"}, false};
constexpr OutputName kWaveformName{"a waveform is a .vcd or .fst, or has a name without extension",
                                   {".vcd", ".fst"}};
constexpr OutputName kScheduleName{"a schedule is a .toml, or has a name without extension",
                                   {".toml"}};
constexpr OutputName kProgramName{"a memory image is a .mem or a .hex", {".mem", ".hex"}, false};
constexpr OutputName kPageName{"a report is a .html", {".html", ".htm"}, false};
constexpr OutputName kDiagramName{"a diagram is a .png or a .svg", {".png", ".svg"}, false};

}  // namespace stipple
