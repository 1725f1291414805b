#include "decoder/reddy2011/sparse_frames.h"

#include <gtest/gtest.h>

#include <random>

#include "tests/decoder/recordings.h"

namespace stipple {
namespace {

constexpr FrameShape kShape{.rows = 16, .cols = 20, .planes = 3};
constexpr int kSlots = 4;

/// Random shifts that stay within the frame.
std::vector<MotionField> random_motion(std::uint32_t seed) {
    std::mt19937 random(seed);
    std::vector<MotionField> fields(2);
    fields[1].step = -1;
    for (MotionField& field : fields)
        for (int slot = 0; slot < kSlots; ++slot)
            for (int row = 0; row < kShape.rows; ++row)
                for (int col = 0; col < kShape.cols; ++col) {
                    const auto to = [&](int last) {
                        return static_cast<int>(random() % (64U * static_cast<unsigned>(last) + 1));
                    };
                    const int partner = slot + field.step;
                    field.row_shift.push_back(static_cast<std::int16_t>(to(15) - 64 * row));
                    field.col_shift.push_back(static_cast<std::int16_t>(to(19) - 64 * col));
                    field.confidence.push_back(
                        partner < 0 || partner >= kSlots || random() % 3 == 0 ? 0 : 255);
                }
    return fields;
}

std::vector<float> gradient_of(const FlowLinks& links, const FluxVideo& x) {
    std::vector<float> gradient(x.voxels());
    links.add_gradient(x, 1, gradient);
    return gradient;
}

// B^T B is symmetric and not negative, and its largest value is at most the bound.
TEST(FlowLinksTest, TheGradientIsThatOfASquare) {
    const FlowLinks links(random_motion(1), kShape, 0.5F);
    const FluxVideo a = random_video(kSlots, kShape, 2);
    const FluxVideo b = random_video(kSlots, kShape, 3);
    const auto image = gradient_of(links, a);
    EXPECT_NEAR(dot(image, b.data()), dot(a.data(), gradient_of(links, b)), 1e-2);
    EXPECT_GT(dot(image, a.data()), 0);
    FluxVideo x = a;
    double norm = 0;
    for (int i = 0; i < 30; ++i) {  // power iterations
        const auto next = gradient_of(links, x);
        norm = std::sqrt(dot(next, next));
        for (std::size_t v = 0; v < x.voxels(); ++v)
            x.data()[v] = static_cast<float>(static_cast<double>(next[v]) / norm);
    }
    EXPECT_LT(norm, links.squared_norm_bound());
    EXPECT_GT(norm, links.squared_norm_bound() / 4);
}

// A ramp that moves by half a pixel a slot follows the flow exactly.
TEST(FlowLinksTest, LightThatFollowsTheFlowHasNoGradient) {
    std::vector<MotionField> fields(2);
    FluxVideo x(kSlots, kShape);
    for (MotionField& field : fields) {
        field.step = &field == fields.data() ? 1 : -1;
        field.row_shift.assign(kSlots * kShape.pixels(), 0);
        field.col_shift.assign(kSlots * kShape.pixels(),
                               static_cast<std::int16_t>(32 * field.step));
        field.confidence.assign(kSlots * kShape.pixels(), 0);
        for (std::size_t i = 0; i < field.confidence.size(); ++i) {
            const auto partner = static_cast<int>(i / kShape.pixels()) + field.step;
            const auto col = i % 20;
            field.confidence[i] = partner >= 0 && partner < kSlots && col > 0 && col < 19 ? 200 : 0;
        }
    }
    for (int slot = 0; slot < kSlots; ++slot)
        for (int plane = 0; plane < 3; ++plane)
            for (int row = 0; row < kShape.rows; ++row)
                for (int col = 0; col < kShape.cols; ++col)
                    x.plane(slot, plane)(row, col) = 0.125F * static_cast<float>(col + plane) -
                                                     0.0625F * static_cast<float>(slot);
    const FlowLinks links(fields, kShape, 0.5F);
    EXPECT_NEAR(links.share(), 6.0 / 8 * 18 / 20, 1e-12);
    for (const float g : gradient_of(links, x)) EXPECT_EQ(g, 0);
    EXPECT_EQ(FlowLinks(fields, kShape, 0.9F).share(), 0) << "200 / 255 is less";
}

}  // namespace
}  // namespace stipple
