#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace stipple {

/// What a method made of a recording, measured in a process of its own.
struct MethodFigures {
    double seconds = 0;
    double voxels_per_second = 0;
    double psnr_db = 0;
    double psnr_gamma_db = 0;
    double pu21_psnr_db = 0;
    std::int64_t peak_bytes =
        0;  ///< most memory of that process in RAM, the program's own included
};

/// A recording and the light that it was made of (.npy).
struct RecordedClip {
    std::filesystem::path stream;
    std::filesystem::path truth;
    double brightest = 2;  ///< light that both are clipped at before they are compared
};

/// What is to be measured.
struct MethodRun {
    std::string method;
    std::vector<std::string> settings = {};  ///< as `stipple decode --set`
    /// One thread, and its processor time for seconds: other work on the machine does not count.
    bool one_thread = false;
};

/// Decodes in this process, and prints the figures as one line for `measure_apart`.
void decode_and_print(const RecordedClip& clip, const MethodRun& run);

/// Runs this program again with the argument --child to do so, so that each method has a peak of
/// memory of its own. \throws std::runtime_error if it fails.
[[nodiscard]] MethodFigures measure_apart(const RecordedClip& clip, const MethodRun& run);

}  // namespace stipple
