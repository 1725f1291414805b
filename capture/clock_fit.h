#pragma once

#include <cstdint>
#include <optional>
#include <vector>

namespace stipple {

/// Map from the clock of a device to the monotonic clock of the host:
/// host_ns = device_ns + offset_ns + (device_ns - origin_ns) * drift_ppm * 1e-6.
struct ClockFit {
    std::uint32_t epoch = 0;
    std::uint64_t frames = 0;
    std::int64_t origin_ns = 0;  ///< device stamp of the first frame
    std::int64_t offset_ns = 0;  ///< shortest delay from stamp to arrival, at the origin
    double drift_ppm = 0;        ///< 0 if the frames span less than two bins
    double spread_ns = 0;        ///< root mean square of the bins' deviation from the line
};

/// Fits the line to the frame with the shortest delay in each second: a busy host or link only
/// adds delay, so the minimum is nearest to the truth (as in Moon, Skelly, Towsley, INFOCOM 1999).
/// Memory: 16 bytes per second; after 65536 bins their length doubles.
class ClockFitter {
  public:
    explicit ClockFitter(std::uint32_t epoch = 0) { fit_.epoch = epoch; }

    void add(std::int64_t device_ns, std::int64_t host_ns);
    /// Empty before the first frame.
    [[nodiscard]] std::optional<ClockFit> fit() const;
    [[nodiscard]] std::uint32_t epoch() const { return fit_.epoch; }

  private:
    struct Bin {
        std::int64_t device_ns = 0;  ///< since the origin
        std::int64_t delay_ns = 0;   ///< host minus device, less the first delay
    };
    void merge_bins();

    ClockFit fit_;
    std::int64_t bin_ns_ = 1'000'000'000;
    std::int64_t current_bin_ = 0;
    std::vector<Bin> bins_;
};

}  // namespace stipple
