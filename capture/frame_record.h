#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "core/named_value.h"
#include "io/pixel_format.h"

namespace stipple {

/// Where and how the pixels of a frame lie. Region in pixels of the sensor.
struct FrameLayout {
    const PixelFormat* format = nullptr;
    int offset_x = 0;
    int offset_y = 0;
    int width = 0;
    int height = 0;
    std::size_t stride_bytes = 0;  ///< from row to row; at least format->row_bytes(width)

    /// Bytes that a complete frame has: stride_bytes * (height - 1) + the last row.
    [[nodiscard]] std::size_t payload_bytes() const {
        if (format == nullptr || height <= 0) return 0;
        return stride_bytes * (static_cast<std::size_t>(height) - 1) + format->row_bytes(width);
    }
    friend bool operator==(const FrameLayout&, const FrameLayout&) = default;
};

enum class FrameStatus : std::uint8_t {
    kComplete = 0,
    kMissingPackets = 1,  ///< the transport lost a part for good
    kSizeMismatch = 2,    ///< fewer or more bytes than its layout needs
    kDeviceError = 3,     ///< the device or its driver says that the content is damaged
    kOtherLayout = 4,     ///< no image, or not of a known format and a size that can be; never kept
};

/// Why frames before this one are missing.
enum class GapCause : std::uint8_t {
    kNone = 0,
    kDevice = 1,        ///< ids that the camera itself left out
    kTransport = 2,     ///< lost between camera and host
    kHostUnderrun = 3,  ///< no buffer was free
    kQueueDrop = 4,     ///< our queue was full
    kReconnect = 5,     ///< the camera was lost; its ids do not tell the number of frames
    kLayout = 6,        ///< the camera sent what cannot be used: no image, or of another format
};
inline constexpr auto kGapCauses =
    std::to_array<NamedValue<GapCause>>({{"none", GapCause::kNone},
                                         {"device", GapCause::kDevice},
                                         {"transport", GapCause::kTransport},
                                         {"host_underrun", GapCause::kHostUnderrun},
                                         {"queue_drop", GapCause::kQueueDrop},
                                         {"reconnect", GapCause::kReconnect},
                                         {"layout", GapCause::kLayout}});
/// Missing frames by their cause.
using LostFrames = std::array<std::uint64_t, kGapCauses.size()>;

/// Which clock gave a device stamp.
enum class StampSource : std::uint8_t {
    kNone = 0,              ///< the device gives no stamp
    kDeviceClock = 1,       ///< the camera's own clock
    kHostStartOfFrame = 2,  ///< the driver, host monotonic clock, start of exposure or of frame
    kHostEndOfFrame = 3,    ///< the driver, host monotonic clock, end of frame
    kUnnamedClock = 4,      ///< a stamp on a clock that the driver does not name
};

/// What is known of a frame beside its pixels.
struct FrameRecord {
    std::uint64_t id = 0;           ///< unwrapped; 0 is the first frame that the session knows of
    std::uint64_t wire_id = 0;      ///< as the device sent it
    std::uint32_t epoch = 0;        ///< grows as docs/recording_format.md says
    std::uint64_t lost_before = 0;  ///< frames missing since the one before, or since the start
    GapCause cause = GapCause::kNone;
    FrameStatus status = FrameStatus::kComplete;
    StampSource stamp_source = StampSource::kNone;
    std::int64_t device_ns = 0;          ///< stamp of the device
    std::int64_t host_monotonic_ns = 0;  ///< CLOCK_MONOTONIC at arrival
    std::int64_t host_realtime_ns = 0;   ///< CLOCK_REALTIME at arrival
    std::optional<double> exposure_us;   ///< of this frame where the device tells, else the setting
    std::optional<double> gain;          ///< in the unit of the device
    std::optional<double> black_level_dn;
    FrameLayout layout;
    std::size_t bytes_received = 0;
    std::uint64_t payload_hash = 0;  ///< XXH3, 64 bit, of the stored payload
};

/// CLOCK_MONOTONIC: nanoseconds since some start of the host.
[[nodiscard]] inline std::int64_t monotonic_ns() {
    return std::chrono::nanoseconds(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// CLOCK_REALTIME: nanoseconds since 1970, UTC; may be set back.
[[nodiscard]] inline std::int64_t realtime_ns() {
    return std::chrono::nanoseconds(std::chrono::system_clock::now().time_since_epoch()).count();
}

/// A frame in its wire format.
struct CapturedFrame {
    FrameRecord record;
    std::vector<std::uint8_t> payload;  ///< bytes of the image alone, no chunks; holes are zero
    std::vector<std::pair<std::size_t, std::size_t>> holes;  ///< [begin, end) of payload, if known
};

}  // namespace stipple
