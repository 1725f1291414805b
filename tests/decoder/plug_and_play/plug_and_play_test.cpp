#include "decoder/plug_and_play/plug_and_play.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "core/config.h"
#include "core/error.h"
#include "decoder/best/patch_denoiser.h"
#include "decoder/measurements.h"
#include "decoder/pixel_response.h"
#include "decoder/plug_and_play/network_denoiser.h"
#include "tests/decoder/recordings.h"
#include "tests/support/temporary_folder.h"

namespace stipple {
namespace {

constexpr FrameShape kShape{.rows = 24, .cols = 28, .planes = 1};
const CollaborativeOptions kShort{.iterations = 4, .light_offset = 0.5F};

Measurements samples() {
    return measure(moving_bar(kShape),
                   random_schedule(kShape.rows, kShape.cols, kPaperExposureSlots, 1));
}

FluxVideo decoded(const Denoiser& denoiser) {
    Measurements m = samples();
    const ProgressCallback progress = [](double) { return true; };
    PlugAndPlayOptions own;
    own.denoiser = [&](const CollaborativeOptions&, bool) { return denoiser; };
    return *decode_plug_and_play({m, SampleNoise(Calibration{}), progress}, kShort, own);
}

TEST(PlugAndPlayTest, WithTheFilterOfBestItHasItsBits) {
    Measurements m = samples();
    const auto best = decode_collaborative(m, SampleNoise(Calibration{}), kShort);
    EXPECT_TRUE(std::ranges::equal(decoded(PatchDenoiser(kShort, false)).data(), best->data()));
}

TEST(PlugAndPlayTest, ADenoiserThatKnowsTheTruthGivesItBack) {
    const FluxVideo truth = moving_bar(kShape);
    int calls = 0;
    const FluxVideo result = decoded([&](const DenoiserInput& input, FluxVideo& clean) {
        EXPECT_EQ(input.iteration, calls++);
        for (std::size_t i = 0; i < clean.voxels(); ++i)
            clean.data()[i] = 2 * std::sqrt(truth.data()[i] + kShort.light_offset);
    });
    EXPECT_EQ(calls, kShort.iterations);
    // x = z^2 / 4 - offset rounds numbers around 1.
    for (std::size_t i = 0; i < truth.voxels(); ++i)
        ASSERT_NEAR(result.data()[i], truth.data()[i], 1e-6);
}

TEST(PlugAndPlayTest, WhatTheDenoiserThrowsEndsIt) {
    EXPECT_THROW(decoded([](const DenoiserInput&, FluxVideo&) { throw std::out_of_range("mine"); }),
                 std::out_of_range);
    for (const float bad : {std::numeric_limits<float>::quiet_NaN(), 2e9F, -2e9F})
        expect_parts(message_of<InputError>([&] {
                         return decoded([&](const DenoiserInput& input, FluxVideo& clean) {
                             clean = input.noisy;
                             clean.plane(3, 0)(2, 1) = bad;
                         });
                     }),
                     {"denoiser: ", "slot 3, row 2, column 1", "finite"});
}

TEST(PlugAndPlayTest, NeedsADenoiser) {
    Measurements m = samples();
    const ProgressCallback progress = [](double) { return true; };
    expect_parts(
        message_of<InputError>([&] {
            return decode_plug_and_play({m, SampleNoise(Calibration{}), progress}, kShort, {});
        }),
        {"plug_and_play: has no denoiser", "decoder.denoiser = net.onnx"});
    PlugAndPlayOptions options;
    Config even({"denoiser_frames=4"}, "decoder");
    expect_parts(message_of<InputError>([&] { read_options(even, options); }),
                 {"denoiser_frames", "4 is even"});
}

TEST(NetworkDenoiserTest, RefusesWhatIsNoNetwork) {
    for (const std::vector<std::uint8_t>& bytes :
         {std::vector<std::uint8_t>{}, std::vector<std::uint8_t>(100, 7)})
        expect_parts(message_of<InputError>([&] { return network_denoiser("net.onnx", bytes, 1); }),
                     {"net.onnx: is not a network in ONNX"});
}

}  // namespace
}  // namespace stipple
