#include "view/viewed_video.h"

#include <algorithm>
#include <utility>

#include "core/index.h"
#include "study/report/report_page.h"
#include "view/mosaic_picture.h"

namespace stipple {

ViewedVideo::ViewedVideo(std::filesystem::path source, FootageOptions options,
                         std::function<void(const Message&)> warn)
    : source_(std::move(source)),
      options_(std::move(options)),
      name_(source_.filename().empty() ? source_.parent_path().filename().string()
                                       : source_.filename().string()),
      warn_(std::move(warn)) {
    open();
    warn_ = [](const Message&) {};  // once is enough
    shape_ = reader_->shape();
    filter_ = reader_->filter();
    if (filter_ != ColourFilter::kNone) shape_.planes = 3;
    if (const auto declared = reader_->slots()) {
        slots_ = *declared;
    } else {
        while (!reader_->next().empty()) ++slots_;
        open();
    }
}

void ViewedVideo::open() {
    reader_ = std::make_unique<ReadAhead>(source_, options_, warn_);
    next_ = 0;
}

std::vector<std::uint16_t> ViewedVideo::codes(std::int64_t slot) {
    const std::lock_guard lock(mutex_);
    if (slot < 0 || slot >= slots_) return {};
    if (slot < next_) open();
    if (slot > next_) reader_->skip(static_cast<int>(slot - next_));
    const auto frame = reader_->next();
    next_ = slot + 1;
    if (filter_ == ColourFilter::kNone) return light_codes(frame);
    return light_codes(coloured(frame, reader_->shape(), filter_));
}

std::optional<std::uint16_t> ViewedVideo::code(std::int64_t slot, int plane, int row, int col) {
    const auto all = codes(slot);
    if (all.empty()) return {};
    return all[index(plane) * shape_.pixels() + row_major(row, col, shape_.cols)];
}

}  // namespace stipple
