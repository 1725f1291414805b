#include "capture/recording/recording_footage.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/error.h"
#include "core/gap_limit.h"

namespace stipple {
namespace {

FrameShape shape_of(const FrameLayout& layout) {
    return {layout.height, layout.width, layout.format->planes};
}

}  // namespace

void check_recording_options(const std::filesystem::path& recording,
                             const FootageOptions& options) {
    if (options.transfer.value_or(Transfer::kLinear) != Transfer::kLinear || options.luminance ||
        options.min_value || options.max_value || options.raw || options.scale != 1 ||
        options.part != FootagePart())
        throw InputError(recording.string(),
                         "is a recording of a camera, whose numbers are linear: the options for "
                         "transfer, raw format, luminance, scale, minimum, maximum, frames and "
                         "part of the frame are for other footage");
}

RecordingFootage::RecordingFootage(const std::filesystem::path& file,
                                   RecordingFootageOptions options)
    : file_(file),
      reader_(file),
      options_(options),
      has_coming_(advance()),
      light_((has_coming_ ? coming_.record.layout
                          : throw InputError(file.string(), "holds no frame that can be used")),
             options.black_level_dn) {}

bool RecordingFootage::advance() {
    const FrameLayout layout = coming_.record.layout;
    to_hold_ = 0;
    while (reader_.next(coming_)) {
        const FrameRecord& record = coming_.record;
        const bool usable = !options_.drop_incomplete || record.status == FrameStatus::kComplete;
        rate_.add(record);
        const std::uint64_t gap = filler_.next(record, usable).held;
        missing_ += gap;
        if (options_.hold_missing) to_hold_ += gap;
        if (gap > 0) note(gap);
        if (!usable) continue;
        if (layout.format != nullptr && record.layout != layout)
            throw InputError(file_.string(),
                             fmt::format("frame {} has another region or pixel format than those "
                                         "before; footage has one",
                                         record.id));
        check_proportion(record);
        return true;
    }
    to_hold_ = 0;
    return false;
}

/// Counts a frame that is used and the slots held before it. \throws InputError if these are too
/// many.
void RecordingFootage::check_proportion(const FrameRecord& record) {
    ++usable_;
    holding_ += static_cast<std::int64_t>(to_hold_);
    if (options_.fill_gaps || holding_ <= max_missing_slots(usable_, shape_of(record.layout)))
        return;
    throw InputError(file_.string(),
                     fmt::format("{} frames are missing or incomplete before frame {}, which makes "
                                 "{} of {}; replay it, which holds the frame before for them "
                                 "with ",
                                 to_hold_, record.id, holding_, holding_ + usable_) +
                         Parameter{"fill_gaps", "true"} + ", and leaves them out with " +
                         Parameter{"skip_gaps", "true"});
}

/// Frames one after the other that are missing are one place.
void RecordingFootage::note(std::uint64_t frames) {
    if (!gaps_.empty() && gaps_.back().slot == slots_)
        gaps_.back().frames += frames;
    else if (gaps_.size() < kMaxListedGaps)
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
