#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <ostream>
#include <string>

#include "study/metrics/video_quality.h"

namespace stipple {

/// What a figure of quality may lose before a test fails. Decoders give the same bits everywhere,
/// so the figures are exact; a change of bits on purpose may move them a little.
inline constexpr double kMarginDb = 0.3;

/// Expects `found_db` to be at most kMarginDb below `measured_db`, what a run of the test gave: the
/// results of the run hold it under `name`. After an improvement, `measured_db` is raised.
inline void expect_quality(const std::string& name, double found_db, double measured_db) {
    testing::Test::RecordProperty(name, std::to_string(found_db));
    EXPECT_GE(found_db, measured_db - kMarginDb) << name;
}

/// PSNR in dB of linear light, after 1/2.2, and of PU21.
struct MeasuredQuality {
    double psnr;
    double gamma;
    double pu21;
};

/// What was measured on a clip, decoded from samples of the schedules `random` and `tiled`.
struct ClipFigures {
    std::string name;
    MeasuredQuality random;
    MeasuredQuality tiled = {};
};

inline void PrintTo(const ClipFigures& clip, std::ostream* stream) {
    *stream << clip.name;
}

inline void expect_quality(const std::string& name, const VideoQuality& found,
                           const MeasuredQuality& measured) {
    expect_quality(name + "_psnr_db", found.psnr_db, measured.psnr);
    expect_quality(name + "_psnr_gamma_db", found.psnr_gamma_db, measured.gamma);
    expect_quality(name + "_pu21_psnr_db", found.pu21_psnr_db, measured.pu21);
}

/// By how many dB an error is below another; both are mean squares.
inline double gain_db(double error, double other_error) {
    return 10 * std::log10(other_error / error);
}

}  // namespace stipple
