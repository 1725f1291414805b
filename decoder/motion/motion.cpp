#include "decoder/motion/motion.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <utility>
#include <vector>

#include "core/parallel.h"
#include "decoder/motion/inverse_search.h"

namespace stipple {
namespace {

constexpr double kBlurPixels = 0.7;

/// Slightly blurred.
cv::Mat flow_image(const FluxVideo& video, int slot) {
    std::vector<std::uint8_t> levels = grey_levels(video, slot);
    const cv::Mat sharp(video.shape().rows, video.shape().cols, CV_8U, levels.data());
    cv::Mat image;
    cv::GaussianBlur(sharp, image, {}, kBlurPixels);
    return image;
}

/// An image at full resolution, at half, and so on, each with the border that a flow needs.
using Pyramid = std::vector<cv::Mat>;

Pyramid pyramid_of(cv::Mat image) {
    Pyramid levels;
    for (;;) {
        cv::Mat& level = levels.emplace_back();
        cv::copyMakeBorder(image, level, kFlowBorder, kFlowBorder, kFlowBorder, kFlowBorder,
                           cv::BORDER_REPLICATE);
        if (std::min(image.rows, image.cols) < 4 * kFlowPatchSide) return levels;
        cv::resize(image, image, {image.cols / 2, image.rows / 2}, 0, 0, cv::INTER_AREA);
    }
}

FlowImage flow_image_of(const cv::Mat& level) {
    return {.pixels = level.ptr(kFlowBorder) + kFlowBorder,
            .stride = static_cast<std::ptrdiff_t>(level.step),
            .rows = level.rows - 2 * kFlowBorder,
            .cols = level.cols - 2 * kFlowBorder};
}

/// Twice the resolution: each pixel as the one it is in.
DenseFlow doubled(const DenseFlow& flow, const FlowImage& image) {
    DenseFlow result{image.rows, image.cols, {}, {}};
    const auto pixels = static_cast<std::size_t>(image.rows) * static_cast<std::size_t>(image.cols);
    result.row_shift.reserve(pixels);
    result.col_shift.reserve(pixels);
    for (int row = 0; row < image.rows; ++row)
        for (int col = 0; col < image.cols; ++col) {
            const auto from = static_cast<std::size_t>(
                std::min(row / 2, flow.rows - 1) * flow.cols + std::min(col / 2, flow.cols - 1));
            result.row_shift.push_back(static_cast<std::int16_t>(2 * flow.row_shift[from]));
            result.col_shift.push_back(static_cast<std::int16_t>(2 * flow.col_shift[from]));
        }
    return result;
}

DenseFlow flow(const Pyramid& from, const Pyramid& to, const MotionOptions& options) {
    const std::size_t finest = options.coarse && from.size() > 1 ? 1 : 0;
    DenseFlow result;
    for (std::size_t level = from.size(); level-- > finest;)
        result = inverse_search(flow_image_of(from[level]), flow_image_of(to[level]),
                                result.rows > 0 ? &result : nullptr, options.search);
    return result;
}

/// Flow from each slot to the next, and back from there.
struct Flows {
    explicit Flows(std::size_t pairs) : forth(pairs), back(pairs) {}
    std::vector<DenseFlow> forth;
    std::vector<DenseFlow> back;
};

/// Shifts of one pair of slots, each averaged with those of the pairs before and after that differ
/// little.
DenseFlow averaged_over_time(const std::vector<DenseFlow>& flows, std::size_t pair) {
    const std::size_t first = pair - std::min<std::size_t>(pair, 1);
    const std::size_t end = std::min(pair + 2, flows.size());
    DenseFlow result = flows[pair];
    for (std::size_t i = 0; i < result.row_shift.size(); ++i) {
        float row = 0;
        float col = 0;
        float weights = 0;
        for (std::size_t other = first; other < end; ++other) {
            const float other_row = flows[other].row_shift[i];
            const float other_col = flows[other].col_shift[i];
            const float down = other_row - result.row_shift[i];
            const float right = other_col - result.col_shift[i];
            constexpr float kAlike = 0.5F * kFlowShiftsPerPixel;
            const float weight = 1 / (1 + (down * down + right * right) / (kAlike * kAlike));
            row += weight * other_row;
            col += weight * other_col;
            weights += weight;
        }
        result.row_shift[i] = static_cast<std::int16_t>(row / weights);
        result.col_shift[i] = static_cast<std::int16_t>(col / weights);
    }
    return result;
}

/// What `coarse` is about.
void coarsen(std::vector<DenseFlow>& flows, const FlowImage& image) {
    std::vector<DenseFlow> averaged(flows.size());
    parallel_for(0, static_cast<int>(flows.size()), [&](int pair) {
        const auto i = static_cast<std::size_t>(pair);
        averaged[i] = averaged_over_time(flows, i);
        if (averaged[i].rows < image.rows) averaged[i] = doubled(averaged[i], image);
    });
    flows = std::move(averaged);
}

/// Confidence exp(-(e / it)^2 / 2) where a pixel is led e away by its motion and back again.
constexpr int kConsistency = kFlowShiftsPerPixel;  // one pixel

/// 255 exp(-x) of squared errors e^2, x = e^2 / (2 kConsistency^2) in steps of 1/16: a table, whose
/// bits do not hang on a library's exp in float.
class ConfidenceTable {
  public:
    ConfidenceTable() {
        for (int i = 0; i < kEntries; ++i)
            confidence_[static_cast<std::size_t>(i)] = static_cast<std::uint8_t>(
                std::lround(255 * std::exp(-static_cast<double>(i) / kEntriesPerUnit)));
    }
    [[nodiscard]] std::uint8_t operator()(int squared_error) const {
        const int i = (squared_error + kPerEntry / 2) / kPerEntry;
        return i < kEntries ? confidence_[static_cast<std::size_t>(i)] : std::uint8_t{0};
    }

  private:
    static constexpr int kEntriesPerUnit = 16;
    static constexpr int kEntries = 112;  // 255 exp(-7) rounds to 0
    static constexpr int kPerEntry = 2 * kConsistency * kConsistency / kEntriesPerUnit;
    std::array<std::uint8_t, kEntries> confidence_{};
};

/// One direction of the motion between two slots and the way back, order (row, col).
struct FlowPair {
    const DenseFlow& forth;
    const DenseFlow& back;
};

/// Fills one slot of `field`, as sure as the flow leads back to where it came from.
void write_slot(const FlowPair& flow, std::size_t voxel, MotionField& field) {
    static const ConfidenceTable confidence;
    constexpr int kPerPixel = MotionField::kShiftsPerPixel;
    const int last_row = (flow.forth.rows - 1) * kPerPixel;
    const int last_col = (flow.forth.cols - 1) * kPerPixel;
    const auto rounded = [](int shift) { return (shift + kPerPixel / 2) / kPerPixel; };
    std::size_t i = 0;
    for (int row = 0; row <= last_row; row += kPerPixel)
        for (int col = 0; col <= last_col; col += kPerPixel, ++i, ++voxel) {
            const int to_row = row + flow.forth.row_shift[i];
            const int to_col = col + flow.forth.col_shift[i];
            if (to_row < 0 || to_col < 0 || to_row > last_row || to_col > last_col) continue;
            const auto there = static_cast<std::size_t>(rounded(to_row)) *
                                   static_cast<std::size_t>(flow.forth.cols) +
                               static_cast<std::size_t>(rounded(to_col));
            const int row_error = flow.forth.row_shift[i] + flow.back.row_shift[there];
            const int col_error = flow.forth.col_shift[i] + flow.back.col_shift[there];
            field.row_shift[voxel] = flow.forth.row_shift[i];
            field.col_shift[voxel] = flow.forth.col_shift[i];
            field.confidence[voxel] = confidence(row_error * row_error + col_error * col_error);
        }
}

}  // namespace

std::vector<MotionField> estimate_motion(const FluxVideo& video, const MotionOptions& options) {
    const auto count = [](int n) { return static_cast<std::size_t>(n); };
    std::vector<Pyramid> pyramid(count(video.slots()));
    parallel_for(0, video.slots(),
                 [&](int slot) { pyramid[count(slot)] = pyramid_of(flow_image(video, slot)); });
    std::vector<MotionField> fields(2);
    fields[1].step = -1;
    const std::size_t pixels = video.shape().pixels();
    for (MotionField& field : fields) {
        field.row_shift.resize(count(video.slots()) * pixels);
        field.col_shift.resize(count(video.slots()) * pixels);
        field.confidence.resize(count(video.slots()) * pixels);
    }
    Flows flows(count(video.slots() - 1));
    parallel_for(0, video.slots() - 1, [&](int slot) {
        const Pyramid& now = pyramid[count(slot)];
        const Pyramid& next = pyramid[count(slot + 1)];
        flows.forth[count(slot)] = flow(now, next, options);
        flows.back[count(slot)] = flow(next, now, options);
    });
    if (options.coarse)
        for (auto* direction : {&flows.forth, &flows.back})
            coarsen(*direction, flow_image_of(pyramid[0][0]));
    parallel_for(0, video.slots() - 1, [&](int slot) {
        const DenseFlow& forth = flows.forth[count(slot)];
        const DenseFlow& back = flows.back[count(slot)];
        write_slot({forth, back}, count(slot) * pixels, fields[0]);
        write_slot({back, forth}, count(slot + 1) * pixels, fields[1]);
    });
    return fields;
}

}  // namespace stipple
