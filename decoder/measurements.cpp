#include "decoder/measurements.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <optional>

#include "core/error.h"
#include "core/exposure_schedule.h"
#include "core/index.h"
#include "core/parallel.h"
#include "decoder/pixel_response.h"

namespace stipple {
namespace {

class Collector {
  public:
    Collector(const StreamHeader& header, const VideoWindow& window, Measurements& measurements)
        : schedule_(header.schedule),
          array_(header.shape),
          cfa_(header.cfa),
          responses_(header),
          window_(window),
          out_(measurements) {
        if (header.sites.empty() && header.calibration.tile.pixels.empty())
            same_response_ = responses_.at(0, 0, 0);
    }

    void add(const SamplePacket& packet) {
        if (packet.slot < window_.first_slot || packet.slot >= window_.first_slot + window_.slots ||
            packet.dn.empty())
            return;
        const int begin = std::max(packet.first_row, window_.first_row);
        const int end =
            std::min(packet.first_row + packet.rows, window_.first_row + window_.shape.rows);
        if (begin >= end) return;
        const std::uint16_t* dn =
            packet.dn.data() +
            index(array_.planes) * count_due(schedule_, packet.slot, packet.first_row,
                                             begin - packet.first_row, array_.cols);
        for (int row = begin; row < end; ++row)
            visit_due_pixels(schedule_, packet.slot, row, array_.cols,
                             [&](int col, const DuePixel& pixel) {
                                 place(packet.slot, row, col, {dn, pixel});
                                 dn += array_.planes;
                             });
    }

  private:
    struct Sample {
        const std::uint16_t* dn;  ///< one for each plane
        DuePixel pixel;
    };

    void place(std::int64_t last_slot, int row, int col, const Sample& sample) {
        const int window_row = row - window_.first_row;
        const int window_col = col - window_.first_col;
        const std::int64_t begin = last_slot - sample.pixel.span_slots + 1;
        const std::int64_t first = begin - window_.first_slot;
        if (window_col < 0 || window_col >= window_.shape.cols || first < 0) return;
        const Span span = span_of(begin, row, col, sample.pixel);
        const auto sites = window_.shape.sites();
        const int first_plane = cfa_ == ColourFilter::kNone ? 0 : colour_plane(cfa_, row, col);
        auto voxel = index(first) * sites + index(first_plane) * window_.shape.pixels() +
                     row_major(window_row, window_col, window_.shape.cols);
        for (int plane = 0; plane < array_.planes; ++plane, voxel += window_.shape.pixels()) {
            if (same_response_) {
                write(voxel, sample.dn[plane], span, *same_response_);
                continue;
            }
            const PixelResponse response = responses_.at(plane, row, col);
            if (!response.defect()) write(voxel, sample.dn[plane], span, response);
        }
        if (schedule_.weighted()) write_weights(index(first), span, {begin, row, col});
    }

    struct Span {
        std::uint64_t open_slots;
        int slots;
        int light_slots;          ///< those of open_slots
        std::uint8_t open_state;  ///< kOpen, and the chain
    };

    void write(std::size_t first_voxel, std::uint16_t dn, const Span& span,
               const PixelResponse& response) {
        const auto sites = window_.shape.sites();
        for (int i = 1; i + 1 < span.slots; ++i)
            if ((span.open_slots >> static_cast<unsigned>(i) & 1U) != 0)
                out_.state[first_voxel + index(i) * sites] = span.open_state;
        const std::size_t last_voxel = first_voxel + index(span.slots - 1) * sites;
        // Stored, not changed: these voxels are far from each other, and a load would wait.
        const int first = span.open_state | Measurements::kFirst;
        const int last = (span.slots == 1 ? first : span.open_state) | Measurements::kLast |
                         (response.saturated(dn) ? Measurements::kSaturated : 0) |
                         (dn == 0 ? Measurements::kZero : 0);
        out_.state[first_voxel] = static_cast<std::uint8_t>(first);
        out_.state[last_voxel] = static_cast<std::uint8_t>(last);
        const float light = response.light(dn, span.light_slots);
        out_.sum[last_voxel] = light;
        out_.variance[last_voxel] = response.noise().variance(light);
        if (out_.dark_variance.empty()) return;
        out_.dark_variance[last_voxel] = response.dark_variance(dn, span.light_slots);
        out_.variance_per_light[last_voxel] = response.variance_per_light(light);
        out_.variance[last_voxel] = out_.variance_at(last_voxel, light);
    }

    struct FirstSlot {
        std::int64_t slot;
        int row;
        int col;
    };

    /// `first` is the slot of the window in which the exposure begins.
    void write_weights(std::size_t first, const Span& span, const FirstSlot& at) {
        const auto pixel =
            row_major(at.row - window_.first_row, at.col - window_.first_col, window_.shape.cols);
        for (int i = 0; i < span.slots; ++i) {
            if ((span.open_slots >> static_cast<unsigned>(i) & 1U) == 0) continue;
            const float weight =
                schedule_.weight(static_cast<int>((at.slot + i) % schedule_.period_slots()),
                                 at.row % schedule_.tile_rows(), at.col % schedule_.tile_cols());
            std::size_t voxel = (first + index(i)) * window_.shape.sites() + pixel;
            for (int plane = 0; plane < window_.shape.planes; ++plane) {
                if ((out_.state[voxel] & Measurements::kOpen) != 0) out_.weight[voxel] = weight;
                voxel += window_.shape.pixels();
            }
        }
    }

    /// `begin` is 0 or more, or the pixel were not due.
    [[nodiscard]] Span span_of(std::int64_t begin, int row, int col, const DuePixel& pixel) const {
        if (pixel.light_slots == pixel.span_slots && !out_.interleaved)  // most, without a search
            return {open_without_gap(pixel.span_slots), pixel.span_slots, pixel.light_slots,
                    Measurements::kOpen};
        const std::int64_t period = schedule_.period_slots();
        const int tile_row = row % schedule_.tile_rows();
        const int tile_col = col % schedule_.tile_cols();
        const std::size_t i = exposure_starting_at(schedule_, tile_row, tile_col, begin);
        const std::uint64_t open_slots = schedule_.exposures(tile_row, tile_col)[i].open_slots;
        const bool second = schedule_.store(tile_row, tile_col, i, begin / period) != 0;
        const int open_state = Measurements::kOpen | (second ? Measurements::kSecond : 0);
        return {open_slots, pixel.span_slots, pixel.light_slots,
                static_cast<std::uint8_t>(open_state)};
    }

    const ExposureSchedule& schedule_;
    FrameShape array_;
    ColourFilter cfa_;
    SiteResponses responses_;
    std::optional<PixelResponse> same_response_;  ///< of all sites, without a calibration of them
    VideoWindow window_;
    Measurements& out_;
};

}  // namespace

FrameShape decoded_shape(const StreamHeader& header) {
    FrameShape shape = header.shape;
    if (header.cfa != ColourFilter::kNone) shape.planes = 3;
    return shape;
}

void collect_measurements(const StreamHeader& header, std::span<const SamplePacket> packets,
                          const VideoWindow& window, Measurements& result) {
    assert(window.shape.planes == decoded_shape(header).planes);
    if (header.schedule.charge_stores() > 2)
        throw InputError("exposure schedule",
                         fmt::format("{} exposures of a pixel are under way at once; this decoder "
                                     "follows two at most",
                                     header.schedule.charge_stores()));
    result.slots = window.slots;
    result.shape = window.shape;
    result.state.assign(window.voxels(), 0);
    result.sum.assign(window.voxels(), 0);
    result.variance.assign(window.voxels(), 0);
    result.interleaved = header.schedule.interleaved();
    result.mosaic = header.cfa != ColourFilter::kNone;
    const Calibration& calibration = header.calibration;
    if (calibration.dark_e_per_slot != 0 || !calibration.tile.pixels.empty() ||
        !header.sites.empty()) {
        result.dark_variance.assign(window.voxels(), 0);
        result.variance_per_light.assign(window.voxels(), 0);
    }
    if (header.schedule.weighted()) result.weight.assign(window.voxels(), 1.0F);
    Collector collector(header, window, result);
    parallel_for(0, static_cast<int>(packets.size()),
                 [&](int i) { collector.add(packets[index(i)]); });
}

Measurements collect_measurements(const StreamHeader& header, std::span<const SamplePacket> packets,
                                  const VideoWindow& window) {
    Measurements result;
    collect_measurements(header, packets, window, result);
    return result;
}

}  // namespace stipple
