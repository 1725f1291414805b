#include "decoder/portz2013/patch_matches.h"

#include <malloc.h>

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <optional>
#include <span>
#include <vector>

#include "core/light.h"
#include "core/parallel.h"
#include "decoder/motion/lazy_opencv.h"
#include "decoder/motion/motion.h"

namespace stipple {
namespace {

std::size_t count(int n) {
    return static_cast<std::size_t>(n);
}

/// sqrt(luminance). OpenCV takes 1.0 for level 255 and sets no upper end, so highlights move too.
cv::Mat flow_image(const FluxVideo& video, int slot) {
    const FrameShape shape = video.shape();
    cv::Mat image(shape.rows, shape.cols, CV_32F);
    const std::span levels(image.ptr<float>(), shape.pixels());
    if (shape.planes == 3)
        reduce_to_luminance(video.frame(slot), levels);
    else
        std::ranges::copy(video.frame(slot).first(levels.size()), levels.begin());
    for (float& level : levels) level = std::sqrt(std::max(level, 0.0F));
    return image;
}

/// Flow from each slot to the next and to the one before; the ends of the video have one only.
struct Flows {
    std::vector<cv::Mat> forth;
    std::vector<cv::Mat> back;

    [[nodiscard]] const cv::Mat& from(int slot, int direction) const {
        return direction > 0 ? forth[count(slot)] : back[count(slot)];
    }
};

void tv_l1_flow(cv::Mat from, cv::Mat to, cv::Mat& flow) {
    const auto plane = [](cv::Mat& image) {
        return PlaneView(image.ptr<float>(), image.rows, image.cols);
    };
    flow.create(from.size(), CV_32FC2);
    tv_l1_flow(plane(from), plane(to), {flow.ptr<float>(), 2 * flow.total()});
}

Flows tv_l1_flows(const FluxVideo& video, const ProgressCallback& progress) {
    constexpr int kBatch = 8;
    Flows flows{std::vector<cv::Mat>(count(video.slots())),
                std::vector<cv::Mat>(count(video.slots()))};
    const int pairs = video.slots() - 1;
    for (int begin = 0; begin < pairs; begin += kBatch) {
        const int end = std::min(begin + kBatch, pairs);
        parallel_for(2 * begin, 2 * end, [&](int i) {
            const int slot = i / 2;
            const bool forth = i % 2 == 0;
            tv_l1_flow(flow_image(video, forth ? slot : slot + 1),
                       flow_image(video, forth ? slot + 1 : slot),
                       forth ? flows.forth[count(slot)] : flows.back[count(slot + 1)]);
        });
        if (!progress(static_cast<double>(end) / pairs)) break;
    }
    malloc_trim(0);  // the flow's own images, which glibc would keep
    return flows;
}

/// Flow at a place between pixels; nothing outside the frame. Order (x, y).
std::optional<cv::Vec2f> flow_at(const cv::Mat& flow, cv::Point2f at) {
    const auto last_col = static_cast<float>(flow.cols - 1);
    const auto last_row = static_cast<float>(flow.rows - 1);
    if (!(at.x >= 0 && at.y >= 0 && at.x <= last_col && at.y <= last_row)) return {};
    const int col = std::min(static_cast<int>(at.x), flow.cols - 2);
    const int row = std::min(static_cast<int>(at.y), flow.rows - 2);
    const float right = at.x - static_cast<float>(col);
    const float down = at.y - static_cast<float>(row);
    const auto between = [right](const cv::Vec2f& a, const cv::Vec2f& b) {
        return a + right * (b - a);
    };
    const cv::Vec2f upper = between(flow.at<cv::Vec2f>(row, col), flow.at<cv::Vec2f>(row, col + 1));
    const cv::Vec2f lower =
        between(flow.at<cv::Vec2f>(row + 1, col), flow.at<cv::Vec2f>(row + 1, col + 1));
    return upper + down * (lower - upper);
}

/// The blocks of a video and their ways.
class Follower {
  public:
    Follower(const FluxVideo& video, const Flows& flows, const FlowMatchOptions& options)
        : video_(video),
          flows_(flows),
          options_(options),
          size_{.rows = std::min(options.block_px, video.shape().rows),
                .cols = std::min(options.block_px, video.shape().cols),
                .slots = 1} {}

    [[nodiscard]] const PatchSize& size() const { return size_; }

    /// Blocks side by side; the last ones overlap, so that they cover the frame.
    [[nodiscard]] std::vector<PatchPosition> references(int slot) const {
        const int last_row = video_.shape().rows - size_.rows;
        const int last_col = video_.shape().cols - size_.cols;
        std::vector<PatchPosition> list;
        for (int row = 0; row < video_.shape().rows; row += size_.rows)
            for (int col = 0; col < video_.shape().cols; col += size_.cols)
                list.push_back({slot, std::min(row, last_row), std::min(col, last_col)});
        return list;
    }

    void add_matches(const PatchPosition& reference, std::vector<PatchMatch>& matches) const {
        add(reference, reference, matches);
        for (const int direction : {1, -1}) follow(reference, direction, matches);
    }

  private:
    void add(const PatchPosition& reference, const PatchPosition& at,
             std::vector<PatchMatch>& matches) const {
        const float bound = kMaxMatchDistance * 2 * options_.sigma * options_.sigma;
        const float distance = patch_difference(video_, size_, reference, at, bound);
        if (distance > bound) return;
        matches.push_back({static_cast<std::int16_t>(at.slot), static_cast<std::int16_t>(at.row),
                           static_cast<std::int16_t>(at.col),
                           match_weight(distance, options_.sigma)});
    }

    void follow(const PatchPosition& reference, int direction,
                std::vector<PatchMatch>& matches) const {
        const cv::Point2f centre(static_cast<float>(size_.cols - 1) / 2,
                                 static_cast<float>(size_.rows - 1) / 2);
        cv::Point2f at =
            cv::Point2f(static_cast<float>(reference.col), static_cast<float>(reference.row)) +
            centre;
        PatchPosition block = reference;
        for (int step = 1; step <= options_.radius_slots; ++step) {
            const int slot = block.slot;
            const int next = slot + direction;
            if (next < 0 || next >= video_.slots()) return;
            const auto move = flow_at(flows_.from(slot, direction), at);
            if (!move) return;
            at += cv::Point2f((*move)[0], (*move)[1]);
            const auto way_back = flow_at(flows_.from(next, -direction), at);
            if (!way_back) return;
            const cv::Vec2f error = *move + *way_back;
            const float limit = options_.consistency_px * options_.consistency_px;
            if (error[0] * error[0] + error[1] * error[1] > limit) return;
            block = {.slot = next,
                     .row = static_cast<int>(std::floor(at.y - centre.y + 0.5F)),
                     .col = static_cast<int>(std::floor(at.x - centre.x + 0.5F))};
            if (block.row < 0 || block.col < 0 || block.row + size_.rows > video_.shape().rows ||
                block.col + size_.cols > video_.shape().cols)
                return;
            add(reference, block, matches);
        }
    }

    const FluxVideo& video_;
    const Flows& flows_;
    FlowMatchOptions options_;
    PatchSize size_;
};

}  // namespace

MatchList find_flow_matches(const FluxVideo& video, const FlowMatchOptions& options,
                            const ProgressCallback& progress) {
    FlowMatchOptions used = options;
    Flows flows;
    if (std::min(video.shape().rows, video.shape().cols) < kMinMotionSide) used.radius_slots = 0;
    if (used.radius_slots > 0) flows = tv_l1_flows(video, progress);
    MatchList result;
    if (!progress(1)) return result;
    const Follower follower(video, flows, used);
    result.size = follower.size();
    std::vector<MatchList> slots(count(video.slots()));
    parallel_for(0, video.slots(), [&](int slot) {
        MatchList& list = slots[count(slot)];
        for (const PatchPosition& reference : follower.references(slot)) {
            follower.add_matches(reference, list.matches);
            list.groups.push_back({reference, list.matches.size()});
        }
    });
    for (const MatchList& list : slots) {
        const std::size_t before = result.matches.size();
        result.matches.insert(result.matches.end(), list.matches.begin(), list.matches.end());
        for (const MatchGroup& group : list.groups)
            result.groups.push_back({group.reference, before + group.end});
    }
    return result;
}

}  // namespace stipple
