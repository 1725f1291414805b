#include "decoder/portz2013/patch_matches.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"

namespace stipple {
namespace {

struct Candidate {
    float distance;
    PatchPosition at;
};

/// Positions `step` apart, the last one at `last` itself, so that patches cover everything.
std::vector<int> positions(int last, int step) {
    std::vector<int> list;
    for (int at = 0; at < last; at += step) list.push_back(at);
    list.push_back(last);
    return list;
}

/// The nearest candidates so far, nearest first; of equals the first that came.
class Nearest {
  public:
    Nearest(int max_count, float farthest)
        : max_count_(static_cast<std::size_t>(max_count)), farthest_(farthest) {}
    [[nodiscard]] float bound() const {
        return list_.size() < max_count_ ? farthest_ : list_.back().distance;
    }
    void offer(const Candidate& candidate) {
        if (!(candidate.distance < bound())) return;
        const auto where = std::upper_bound(
            list_.begin(), list_.end(), candidate,
            [](const Candidate& a, const Candidate& b) { return a.distance < b.distance; });
        list_.insert(where, candidate);
        if (list_.size() > max_count_) list_.pop_back();
    }
    [[nodiscard]] const std::vector<Candidate>& list() const { return list_; }

  private:
    std::size_t max_count_;
    float farthest_;
    std::vector<Candidate> list_;
};

PatchMatch match_at(const PatchPosition& at, float weight) {
    return {static_cast<std::int16_t>(at.slot), static_cast<std::int16_t>(at.row),
            static_cast<std::int16_t>(at.col), weight};
}

/// The search of one reference patch after another.
class Searcher {
  public:
    Searcher(int slots, FrameShape shape, const MatchSearch& search, const PatchMeasure& measure,
             const MatchCount& max_matches)
        : search_(search), measure_(measure), max_matches_(max_matches) {
        search_.size = {.rows = std::min(search.size.rows, shape.rows),
                        .cols = std::min(search.size.cols, shape.cols),
                        .slots = std::min(search.size.slots, slots)};
        last_ = {.slot = slots - search_.size.slots,
                 .row = shape.rows - search_.size.rows,
                 .col = shape.cols - search_.size.cols};
    }

    [[nodiscard]] const PatchSize& size() const { return search_.size; }

    [[nodiscard]] std::vector<PatchPosition> references() const {
        std::vector<PatchPosition> list;
        for (const int slot : positions(last_.slot, search_.size.slots))
            for (const int row : positions(last_.row, search_.step_px))
                for (const int col : positions(last_.col, search_.step_px))
                    list.push_back({slot, row, col});
        return list;
    }

    [[nodiscard]] std::vector<PatchMatch> matches_of(const PatchPosition& reference) const {
        const float farthest = kMaxMatchDistance * 2 * search_.sigma * search_.sigma;
        const int count = max_matches_(search_.size, reference);
        std::vector<PatchMatch> matches;
        if (search_.with_itself) matches.push_back(match_at(reference, search_.weight));
        if (count <= 0) return matches;
        Nearest nearest(count, farthest);
        const auto low = [](int at, int window) { return std::max(at - window, 0); };
        const auto high = [](int at, int window, int last) { return std::min(at + window, last); };
        PatchPosition at;
        for (at.slot = low(reference.slot, search_.window_slots);
             at.slot <= high(reference.slot, search_.window_slots, last_.slot); ++at.slot)
            for (at.row = low(reference.row, search_.window_px);
                 at.row <= high(reference.row, search_.window_px, last_.row); ++at.row)
                for (at.col = low(reference.col, search_.window_px);
                     at.col <= high(reference.col, search_.window_px, last_.col); ++at.col)
                    offer(reference, at, nearest);
        for (const Candidate& found : nearest.list())
            matches.push_back(
                match_at(found.at, search_.weight * match_weight(found.distance, search_.sigma)));
        return matches;
    }

  private:
    void offer(const PatchPosition& reference, const PatchPosition& at, Nearest& nearest) const {
        if (at.slot == reference.slot && at.row == reference.row && at.col == reference.col) return;
        nearest.offer({measure_(search_.size, reference, at, nearest.bound()), at});
    }

    MatchSearch search_;
    const PatchMeasure& measure_;
    const MatchCount& max_matches_;
    PatchPosition last_;
};

}  // namespace

MatchList find_matches(const VideoSize& video, const MatchSearch& search,
                       const PatchMeasure& measure, const MatchCount& max_matches,
                       const ProgressCallback& progress) {
    constexpr std::size_t kBatch = 512;  // reference patches between two questions
    const Searcher searcher(video.slots, video.shape, search, measure, max_matches);
    const std::vector<PatchPosition> references = searcher.references();
    MatchList result{.size = searcher.size(), .groups = {}, .matches = {}};
    for (std::size_t begin = 0; begin < references.size(); begin += kBatch) {
        const std::size_t count = std::min(kBatch, references.size() - begin);
        std::vector<std::vector<PatchMatch>> found(count);
        parallel_for(0, static_cast<int>(count), [&](int i) {
            const auto k = static_cast<std::size_t>(i);
            found[k] = searcher.matches_of(references[begin + k]);
        });
        for (std::size_t i = 0; i < count; ++i) {
            result.matches.insert(result.matches.end(), found[i].begin(), found[i].end());
            result.groups.push_back({references[begin + i], result.matches.size()});
        }
        if (!progress(static_cast<double>(begin + count) / static_cast<double>(references.size())))
            break;
    }
    return result;
}

float patch_difference(const FluxVideo& video, const PatchSize& size,
                       const PatchPosition& reference, const PatchPosition& other,
                       float bound) noexcept {
    const FrameShape shape = video.shape();
    const auto offset = [&](const PatchPosition& at) {
        return static_cast<std::size_t>(at.slot) * shape.sites() +
               static_cast<std::size_t>(at.row) * static_cast<std::size_t>(shape.cols) +
               static_cast<std::size_t>(at.col);
    };
    const float* a = &video.data()[offset(reference)];
    const float* b = &video.data()[offset(other)];
    const auto voxels = static_cast<float>(size.slots * shape.planes * size.rows * size.cols);
    float sum = 0;
    for (int slot = 0; slot < size.slots; ++slot)
        for (int plane = 0; plane < shape.planes; ++plane) {
            const std::size_t frame = static_cast<std::size_t>(slot) * shape.sites() +
                                      static_cast<std::size_t>(plane) * shape.pixels();
            for (int row = 0; row < size.rows; ++row) {
                const std::size_t i =
                    frame + static_cast<std::size_t>(row) * static_cast<std::size_t>(shape.cols);
                for (std::size_t k = i; k < i + static_cast<std::size_t>(size.cols); ++k)
                    sum += (a[k] - b[k]) * (a[k] - b[k]);
            }
            if (sum > bound * voxels) return std::numeric_limits<float>::infinity();
        }
    return sum / voxels;
}

float match_weight(float distance, float sigma) noexcept {
    const double s = static_cast<double>(sigma);
    // In double, whose last bits are lost in the rounding: no library's exp in float shows.
    return static_cast<float>(std::exp(-static_cast<double>(distance) / (2 * s * s)));
}

}  // namespace stipple
