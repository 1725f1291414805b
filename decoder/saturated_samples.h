#pragma once

#include <cstdint>

#include "decoder/pixel_response.h"
#include "stream/sample_packet.h"
#include "stream/stream_header.h"

namespace stipple {

/// Counts the samples of packets that are only a lower bound (PixelResponse), and those at DN 0.
class SaturatedSamples {
  public:
    explicit SaturatedSamples(const StreamHeader& header) : header_(header), responses_(header) {}

    void add(const SamplePacket& packet);

    [[nodiscard]] std::uint64_t samples() const { return samples_; }
    [[nodiscard]] std::uint64_t saturated() const { return saturated_; }
    [[nodiscard]] std::uint64_t zeros() const { return zeros_; }

  private:
    const StreamHeader& header_;
    SiteResponses responses_;
    std::uint64_t samples_ = 0;
    std::uint64_t saturated_ = 0;
    std::uint64_t zeros_ = 0;
};

}  // namespace stipple
