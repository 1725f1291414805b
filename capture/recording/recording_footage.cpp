#include "capture/recording/recording_footage.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/error.h"

namespace stipple {
namespace {

constexpr std::uint64_t kMaxHeld = std::uint64_t{1} << 20U;

}  // namespace

RecordingFootage::RecordingFootage(const std::filesystem::path& file,
                                   RecordingFootageOptions options)
    : file_(file),
      reader_(file),
      options_(options),
      has_coming_(advance()),
      light_((has_coming_ ? coming_.record.layout
                          : throw InputError(file.string(), "holds no frame that can be used")),
             options.black_level_dn) {
    to_hold_ = missing_ = 0;  // nothing stands in for what came before the first frame
    gaps_.clear();
}

bool RecordingFootage::advance() {
    const FrameLayout layout = coming_.record.layout;
    to_hold_ = 0;
    while (reader_.next(coming_)) {
        const FrameRecord& record = coming_.record;
        const bool usable = !options_.drop_incomplete || record.status == FrameStatus::kComplete;
        const std::uint64_t lost = last_id_ ? missing_after(*last_id_, record) : record.lost_before;
        last_id_ = record.id;
        rate_.add(record);
        const std::uint64_t gap = std::min(lost, kMaxHeld + 1) + (usable ? 0 : 1);
        missing_ += gap;
        to_hold_ += gap;
        if (gap > 0) note(gap);
        if (!usable) continue;
        if (layout.format != nullptr && record.layout != layout)
            throw InputError(file_.string(),
                             fmt::format("frame {} has another region or pixel format than those "
                                         "before; footage has one",
                                         record.id));
        if (options_.hold_missing && to_hold_ > kMaxHeld)
            throw InputError(file_.string(),
                             fmt::format("more than 2^20 frames are missing before frame {}; leave "
                                         "them out with --skip-gaps",
                                         record.id));
        if (!options_.hold_missing) to_hold_ = 0;
        return true;
    }
    to_hold_ = 0;
    return false;
}

/// Frames one after the other that are missing are one place.
void RecordingFootage::note(std::uint64_t frames) {
    if (!gaps_.empty() && gaps_.back().slot == slots_)
        gaps_.back().frames += frames;
    else if (gaps_.size() < kMostListedGaps)
        gaps_.push_back({slots_, frames});
}

bool RecordingFootage::read(std::span<float> frame) {
    if (!has_coming_) return false;
    ++slots_;
    if (to_hold_ > 0 && !last_.empty()) {
        --to_hold_;
        ++held_;
        std::copy(last_.begin(), last_.end(), frame.begin());
        return true;
    }
    light_.convert(coming_.payload, frame);
    last_.assign(frame.begin(), frame.end());
    has_coming_ = advance();
    return true;
}

}  // namespace stipple
