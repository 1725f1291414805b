#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/geometry.h"
#include "stream/sample_packet.h"
#include "stream/stream_header.h"

namespace stipple {

/// A box of voxels of a video: `slots` slots from `first_slot`, and the pixels from (first_row,
/// first_col); `shape` is the size of one of its frames.
struct VideoWindow {
    std::int64_t first_slot = 0;
    int slots = 0;
    int first_row = 0;
    int first_col = 0;
    FrameShape shape;

    [[nodiscard]] std::size_t voxels() const {
        return static_cast<std::size_t>(slots) * shape.sites();
    }
};

/// The samples y of a window in the units of FluxVideo, as arrays of order (slot, plane, row, col),
/// so that each voxel finds its exposure. Exposures that reach beyond the window, and exposures
/// without a sample, are omitted; their voxels are unobserved. In a mosaic the colours that a pixel
/// does not measure are unobserved too. Interleaved exposures of a pixel (two buckets) form two
/// chains of successive exposures; all bits of a voxel belong to the one exposure in which it is
/// open.
struct Measurements {
    static constexpr std::uint8_t kOpen = 1;       ///< the voxel's light is in a sample
    static constexpr std::uint8_t kFirst = 2;      ///< first voxel of an exposure
    static constexpr std::uint8_t kLast = 4;       ///< last voxel of an exposure, where `sum` is
    static constexpr std::uint8_t kSaturated = 8;  ///< with kLast: the light is `sum` or more
    static constexpr std::uint8_t kSecond = 16;    ///< with kOpen: the exposure is of chain 2
    static constexpr std::uint8_t kPseudo = 32;    ///< with kLast: pseudo_samples.h
    static constexpr std::uint8_t kZero = 64;      ///< with kLast: DN 0, censored_samples.h

    int slots = 0;
    FrameShape shape;
    std::vector<std::uint8_t> state;
    std::vector<float> sum;       ///< y: light of the whole exposure, at its last voxel; else 0
    std::vector<float> variance;  ///< of `sum` at the same voxel; else 0
    bool interleaved = false;     ///< there is a second chain
    bool mosaic = false;          ///< of colours: each pixel is open in only one of three planes

    /// If pixels differ or have dark current, the noise of each exposure at its last voxel:
    /// variance without light, and increase of the variance per unit of light. Otherwise empty.
    std::vector<float> dark_variance = {};
    std::vector<float> variance_per_light = {};

    /// If exposures are weighted: the weight of each observed voxel, 1 of all others. Otherwise
    /// empty, and all weights are 1.
    std::vector<float> weight = {};

    /// If several sensors see the scene (docs/rig.md): the samples of the others, in the same
    /// window. All of them have `dark_variance` and `lsb_light`, and none has others of its own.
    std::vector<Measurements> others = {};
    /// The proximal map takes a sample of DN 0 as a bound: the light is `sum` or less.
    bool zero_is_bound = false;

    float lsb_light = 0;  ///< light of one DN, of a sensor among several; otherwise 0

    [[nodiscard]] float weight_at(std::size_t voxel) const {
        return weight.empty() ? 1.0F : weight[voxel];
    }
    /// Precondition: dark_variance is not empty, voxel is the last of an exposure.
    [[nodiscard]] float variance_at(std::size_t voxel, float light) const {
        return dark_variance[voxel] + variance_per_light[voxel] * (light > 0 ? light : 0);
    }

    [[nodiscard]] std::size_t voxels() const { return state.size(); }
};

/// Calls body(measurements of a sensor) for each of them, the first one first.
template <typename Sensors, typename Body>
void for_each_sensor(Sensors& measurements, const Body& body) {
    body(measurements);
    for (auto& other : measurements.others) body(other);
}

/// Shape of the decoded frames of a stream: three planes if its plane is a mosaic of colours, else
/// the shape of the array.
[[nodiscard]] FrameShape decoded_shape(const StreamHeader& header);

/// Collects the samples of `window` from packets that may contain more, converted by the response
/// of each site (pixel_response.h); a site with a defect has none. The variances are those for a
/// sample equal to its mean. The samples of a mosaic go to the planes of their colours. Exposures
/// under way at a switch of the schedule go across it; those that are unknown there are omitted. If
/// the values of the readout change in the window, each exposure has its own noise. \throws
/// InputError if a pixel has more than two exposures at once. Precondition: window.shape.planes ==
/// decoded_shape(header).planes.
[[nodiscard]] Measurements collect_measurements(const StreamHeader& header,
                                                std::span<const SamplePacket> packets,
                                                const VideoWindow& window);

/// The same in the memory of `result`, whose other samples it replaces.
void collect_measurements(const StreamHeader& header, std::span<const SamplePacket> packets,
                          const VideoWindow& window, Measurements& result);

/// Removes the samples of stuck pixels, so that the prior fills them, and returns the number of
/// these sites. A site with at least four samples is stuck if at most two of its neighbours with
/// samples are unsound (of up to eight neighbours, at least three of them with samples), and
/// - all its samples are saturated, and their bound is at least three times the light of every
///   sound neighbour; or
/// - the sum of its samples is within three standard deviations of no light, and the light of the
///   darkest sound neighbour is at least twenty standard deviations.
/// A site is sound if its samples are neither all saturated nor all dark. Not detected: larger
/// groups of adjacent defects, defects in planes of a mosaic whose neighbouring sites have another
/// colour, and intermittent defects. A single bright or black point that is static for a whole
/// block, with a sharp edge all around, cannot be distinguished from a defect and is lost.
std::size_t mask_defects(Measurements& measurements);

}  // namespace stipple
