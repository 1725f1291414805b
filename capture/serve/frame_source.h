#pragma once

#include <cstdint>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "io/pixel_format.h"

namespace stipple {

/// What a source of frames for a served camera has to offer.
struct ServedImage {
    static constexpr double kUsualFramesHz = 25;  ///< where neither user nor source names a rate
    static constexpr double kMinFramesHz = 0.01;
    static constexpr double kMaxFramesHz = 100'000;

    int width = 0;
    int height = 0;
    std::vector<const PixelFormat*> formats;  ///< at least one; the first is the default
    bool croppable = true;              ///< false: the region is fixed, for the bytes are no image
    double frames_hz = kUsualFramesHz;  ///< unless the client asks for another rate
    std::optional<std::uint64_t> frames = {};  ///< from a start to the end, if known
    std::uint32_t exposure_map_id = 0;         ///< CRC of the exposure schedule, 0 without
    /// Header of the sample stream as hexadecimal digits; empty unless the frames are its packets.
    std::string coded_header = {};
};

struct ServedFrame {
    std::vector<std::uint8_t> payload;           ///< rows without padding, in the format asked for
    std::uint64_t number = 0;                    ///< rises; what it skips a client sees as lost
    std::optional<std::uint64_t> stamp_ns = {};  ///< device time; else that of its due time
};

/// Where a served camera takes its frames from.
class FrameSource {
  public:
    virtual ~FrameSource() = default;
    FrameSource(const FrameSource&) = delete;
    FrameSource& operator=(const FrameSource&) = delete;

    [[nodiscard]] virtual const ServedImage& image() const = 0;
    /// Begins anew, in one of the formats. \throws InputError.
    virtual void start(const PixelFormat& format) = 0;
    /// The next whole frame, or nothing at the end. \throws InputError.
    [[nodiscard]] virtual std::optional<ServedFrame> next() = 0;

    /// What is lost or wrong in the frames, as far as it is known; empty if nothing is. May be
    /// asked while another thread takes the frames.
    [[nodiscard]] std::string warning() const {
        const std::lock_guard lock(mutex_);
        return warning_;
    }

  protected:
    FrameSource() = default;
    void warn(std::string warning) {
        const std::lock_guard lock(mutex_);
        warning_ = std::move(warning);
    }

  private:
    mutable std::mutex mutex_;
    std::string warning_;
};

}  // namespace stipple
