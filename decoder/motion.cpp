#include "decoder/motion.h"

#include <malloc.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>
#include <optional>
#include <span>
#include <vector>

#include "core/light.h"
#include "core/parallel.h"

namespace stipple {
namespace {

constexpr int kPatchPixels = 8;
constexpr int kGradientDescents = 12;
constexpr double kBlurPixels = 0.7;

/// What the flow looks at: 255 sqrt(luminance), 8 bits, slightly blurred. The square root, unlike
/// a power of 1/2.2, is the same bits everywhere.
cv::Mat flow_image(const FluxVideo& video, int slot) {
    const FrameShape shape = video.shape();
    std::span<const float> light = video.frame(slot);
    std::vector<float> luminance;
    if (shape.planes == 3) {
        luminance.resize(shape.pixels());
        reduce_to_luminance(light, luminance);
        light = luminance;
    }
    cv::Mat image(shape.rows, shape.cols, CV_8U);
    for (std::size_t i = 0; i < shape.pixels(); ++i)
        image.data[i] =
            static_cast<std::uint8_t>(255 * std::sqrt(std::clamp(light[i], 0.0F, 1.0F)) + 0.5F);
    cv::GaussianBlur(image, image, {}, kBlurPixels);
    return image;
}

cv::Mat flow(const cv::Mat& from, const cv::Mat& to, const MotionOptions& options) {
    // A new one for each pair: results of one that has been used depend on what it has seen.
    const auto method = cv::DISOpticalFlow::create(cv::DISOpticalFlow::PRESET_MEDIUM);
    method->setFinestScale(options.finest_scale);
    method->setPatchSize(kPatchPixels);
    method->setPatchStride(options.patch_stride_px);
    method->setGradientDescentIterations(kGradientDescents);
    method->setVariationalRefinementIterations(options.refinements);
    cv::Mat result;
    method->calc(from, to, result);
    return result;
}

/// 255 exp(-x) in steps of 1/16: a table, whose bits do not hang on a library's exp in float.
class ConfidenceTable {
  public:
    ConfidenceTable() {
        for (int i = 0; i < kEntries; ++i)
            confidence_[static_cast<std::size_t>(i)] = static_cast<std::uint8_t>(
                std::lround(255 * std::exp(-static_cast<double>(i) / kEntriesPerUnit)));
    }
    [[nodiscard]] std::uint8_t operator()(float x) const {
        const float i = x * kEntriesPerUnit + 0.5F;
        return i < kEntries ? confidence_[static_cast<std::size_t>(i)] : std::uint8_t{0};
    }

  private:
    static constexpr int kEntriesPerUnit = 16;
    static constexpr int kEntries = 112;  // 255 exp(-7) rounds to 0
    std::array<std::uint8_t, kEntries> confidence_{};
};

/// One direction of the motion between two slots and the way back, order (row, col).
struct FlowPair {
    const cv::Mat& forth;
    const cv::Mat& back;
};

/// Where a pixel goes; nothing if that is outside the frame, or too far to be said.
std::optional<cv::Point2f> target(const cv::Mat& forth, int row, int col) {
    constexpr float kFarthest = 500;  // pixels; 2^15 / kShiftsPerPixel is more
    const auto move = forth.at<cv::Vec2f>(row, col);
    const cv::Point2f to(static_cast<float>(col) + move[0], static_cast<float>(row) + move[1]);
    const bool inside = to.x >= 0 && to.y >= 0 && to.x <= static_cast<float>(forth.cols - 1) &&
                        to.y <= static_cast<float>(forth.rows - 1);  // NaN is not
    if (!inside || std::max(std::abs(move[0]), std::abs(move[1])) > kFarthest) return {};
    return to;
}

/// Fills one slot of `field`, as sure as the flow leads back to where it came from.
void write_slot(const FlowPair& flow, float deviation_px, std::size_t voxel, MotionField& field) {
    static const ConfidenceTable confidence;
    const float scale = 0.5F / (deviation_px * deviation_px);
    const auto fixed = [](float pixels) {
        const float shift = pixels * MotionField::kShiftsPerPixel;
        return static_cast<std::int16_t>(shift + (shift < 0 ? -0.5F : 0.5F));
    };
    for (int row = 0; row < flow.forth.rows; ++row)
        for (int col = 0; col < flow.forth.cols; ++col, ++voxel) {
            const auto to = target(flow.forth, row, col);
            if (!to) continue;
            const auto move = flow.forth.at<cv::Vec2f>(row, col);
            const auto error = move + flow.back.at<cv::Vec2f>(static_cast<int>(to->y + 0.5F),
                                                              static_cast<int>(to->x + 0.5F));
            field.row_shift[voxel] = fixed(move[1]);
            field.col_shift[voxel] = fixed(move[0]);
            field.confidence[voxel] =
                confidence((error[0] * error[0] + error[1] * error[1]) * scale);
        }
}

}  // namespace

std::vector<MotionField> estimate_motion(const FluxVideo& video, const MotionOptions& options) {
    const auto count = [](int n) { return static_cast<std::size_t>(n); };
    std::vector<cv::Mat> image(count(video.slots()));
    parallel_for(0, video.slots(), [&](int slot) { image[count(slot)] = flow_image(video, slot); });
    std::vector<MotionField> fields(2);
    fields[1].step = -1;
    const std::size_t pixels = video.shape().pixels();
    for (MotionField& field : fields) {
        field.row_shift.resize(count(video.slots()) * pixels);
        field.col_shift.resize(count(video.slots()) * pixels);
        field.confidence.resize(count(video.slots()) * pixels);
    }
    parallel_for(0, video.slots() - 1, [&](int slot) {
        const cv::Mat& now = image[count(slot)];
        const cv::Mat& next = image[count(slot + 1)];
        const cv::Mat forth = flow(now, next, options);
        const cv::Mat back = flow(next, now, options);
        write_slot({forth, back}, options.consistency_px, count(slot) * pixels, fields[0]);
        write_slot({back, forth}, options.consistency_px, count(slot + 1) * pixels, fields[1]);
    });
    // The flow has taken some 160 bytes a pixel in each thread, which glibc would keep.
    malloc_trim(0);
    return fields;
}

}  // namespace stipple
