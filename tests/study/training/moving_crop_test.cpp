#include "study/training/moving_crop.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/error.h"

namespace stipple {
namespace {

constexpr FrameShape kClipShape{.rows = 6, .cols = 9, .planes = 2};
constexpr FrameShape kShape{.rows = 3, .cols = 4, .planes = 2};
constexpr int kFrames = 8;

/// Linear in frame, plane, row and column: interpolation and means of it are exact.
double ramp(double frame, double plane, double row, double col) {
    return 1 + frame + 0.5 * plane + 0.25 * row + 0.125 * col;
}

template <typename Visit>
void for_each_site(int slots, FrameShape shape, const Visit& visit) {
    std::size_t i = 0;
    for (int slot = 0; slot < slots; ++slot)
        for (int plane = 0; plane < shape.planes; ++plane)
            for (int row = 0; row < shape.rows; ++row)
                for (int col = 0; col < shape.cols; ++col) visit(i++, slot, plane, row, col);
}

std::vector<float> ramp_light() {
    std::vector<float> light(kFrames * kClipShape.sites());
    for_each_site(kFrames, kClipShape, [&](std::size_t i, int frame, int plane, int row, int col) {
        light[i] = static_cast<float>(ramp(frame, plane, row, col));
    });
    return light;
}

std::vector<float> crop_of(const std::vector<float>& light, const MovingCrop& crop) {
    return take_crop({light, kFrames, kClipShape}, crop, kShape);
}

TEST(MovingCropTest, HasTheBitsOfTheFramesAtWholePixels) {
    const auto light = ramp_light();
    const auto part = crop_of(light, {.first_frame = 6, .top = {3, 0}, .left = {0, 5}});
    for_each_site(2, kShape, [&](std::size_t i, int slot, int plane, int row, int col) {
        EXPECT_EQ(part[i], static_cast<float>(ramp(6 + slot, plane, row + (slot == 0 ? 3 : 0),
                                                   col + (slot == 0 ? 0 : 5))));
    });
}

TEST(MovingCropTest, InterpolatesBetweenPixelsAndAveragesFrames) {
    const auto light = ramp_light();
    const MovingCrop crop{
        .first_frame = 0.5, .frames_per_slot = 2.5, .top = {0.3, 3, 2.9}, .left = {1.25, 4.75, 5}};
    const auto part = crop_of(light, crop);
    // Frames 0.5 to 3: half of frame 0, all of 1 and 2; then 3, 4 and half of 5; half of 5, 6
    // and 7.
    const double frame[] = {(0 * 0.5 + 1 + 2) / 2.5, (3 + 4 + 5 * 0.5) / 2.5,
                            (5 * 0.5 + 6 + 7) / 2.5};
    for_each_site(3, kShape, [&](std::size_t i, int slot, int plane, int row, int col) {
        const auto at = static_cast<std::size_t>(slot);
        // Rounding of some additions of numbers up to 16.
        EXPECT_NEAR(part[i], ramp(frame[at], plane, row + crop.top[at], col + crop.left[at]), 1e-5);
    });
}

TEST(MovingCropTest, ScalesLightAfterItsPower) {
    const auto light = ramp_light();
    const auto plain = crop_of(light, {.top = {1}, .left = {2}});
    const auto other = crop_of(light, {.top = {1}, .left = {2}, .light = 0.5, .contrast = 2});
    for (std::size_t i = 0; i < plain.size(); ++i)
        EXPECT_NEAR(other[i], 0.5F * plain[i] * plain[i], 1e-5F * other[i]);
}

TEST(MovingCropTest, RefusesWhatIsNotInTheClip) {
    const auto light = ramp_light();
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (const MovingCrop& wrong :
         {MovingCrop{}, MovingCrop{.top = {0}, .left = {0, 0}},
          MovingCrop{.top = {3.01}, .left = {0}}, MovingCrop{.top = {0}, .left = {5.01}},
          MovingCrop{.top = {-0.1}, .left = {0}}, MovingCrop{.top = {nan}, .left = {0}},
          MovingCrop{.first_frame = 7.1, .top = {0}, .left = {0}},
          MovingCrop{.first_frame = -1, .top = {0}, .left = {0}},
          MovingCrop{.frames_per_slot = 9, .top = {0}, .left = {0}},
          MovingCrop{.frames_per_slot = 0, .top = {0}, .left = {0}},
          MovingCrop{.top = {0}, .left = {0}, .light = nan},
          MovingCrop{.top = {0}, .left = {0}, .contrast = 0}})
        EXPECT_THROW(static_cast<void>(crop_of(light, wrong)), InputError);
    EXPECT_THROW(static_cast<void>(take_crop({light, kFrames, kClipShape},
                                             {.top = {0}, .left = {0}}, {.rows = 3, .cols = 4})),
                 InputError);
}

}  // namespace
}  // namespace stipple
