#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "capture/recording/read_ahead.h"
#include "core/geometry.h"

namespace stipple {

/// Footage, a decoded video or a recording of which any frame can be looked at. For several
/// threads.
class ViewedVideo {
  public:
    /// \throws InputError as ReadAhead.
    ViewedVideo(std::filesystem::path source, FootageOptions options,
                std::function<void(const Message&)> warn);

    [[nodiscard]] const std::string& name() const { return name_; }
    [[nodiscard]] FrameShape shape() const { return shape_; }
    /// The number of frames. Where the source does not declare it, it is read to its end.
    [[nodiscard]] std::int64_t slots() const { return slots_; }
    /// light_code of a frame, order (plane, row, col); empty beyond the end. \throws InputError as
    /// ReadAhead.
    [[nodiscard]] std::vector<std::uint16_t> codes(std::int64_t slot);
    /// The same of one pixel; nothing beyond the end.
    [[nodiscard]] std::optional<std::uint16_t> code(std::int64_t slot, int plane, int row, int col);

  private:
    void open();

    std::filesystem::path source_;
    FootageOptions options_;
    std::string name_;
    std::function<void(const Message&)> warn_;
    std::mutex mutex_;
    std::unique_ptr<ReadAhead> reader_;
    std::int64_t next_ = 0;  ///< the frame that the reader gives next
    FrameShape shape_;       ///< of a picture; a mosaic has three planes
    ColourFilter filter_ = ColourFilter::kNone;
    std::int64_t slots_ = 0;
};

}  // namespace stipple
