#include "decoder/measurements.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cassert>
#include <optional>

#include "core/error.h"
#include "core/exposure_schedule.h"
#include "core/index.h"
#include "core/parallel.h"
#include "decoder/pixel_response.h"
#include "stream/schedule_switch.h"

namespace stipple {
namespace {

/// Of a part of the schedule.
struct Responses {
    Responses(const StreamHeader& header, std::int64_t first_slot)
        : of_sites(header, readout_values(calibration_at(header, first_slot))) {
        if (header.sites.empty() && header.calibration.tile.pixels.empty())
            same = of_sites.at(0, 0, 0);
    }

    SiteResponses of_sites;
    std::optional<PixelResponse> same;  ///< of all sites, without a calibration of them
};

class Collector {
  public:
    Collector(const StreamHeader& header, const VideoWindow& window, Measurements& measurements)
        : schedule_(header.schedule),
          parts_(schedule_parts(header)),
          array_(header.shape),
          cfa_(header.cfa),
          // A sensor of a rig may begin later than the window.
          first_part_(part_at(parts_, std::max<std::int64_t>(window.first_slot, 0))),
          window_(window),
          out_(measurements) {
        for (std::size_t i = first_part_; i < parts_.size(); ++i)
            if (i == first_part_ || parts_[i].first_slot < window.first_slot + window.slots)
                responses_.emplace_back(header, parts_[i].first_slot);
    }

    void add(const SamplePacket& packet) {
        if (packet.slot < window_.first_slot || packet.slot >= window_.first_slot + window_.slots ||
            packet.dn.empty())
            return;
        const int begin = std::max(packet.first_row, window_.first_row);
        const int end =
            std::min(packet.first_row + packet.rows, window_.first_row + window_.shape.rows);
        if (begin >= end) return;
        const std::size_t part = part_at(parts_, packet.slot);
        const ExposureSchedule& schedule = *parts_[part].schedule;
        const std::int64_t slot = readout_slot(parts_[part], packet.slot);
        const std::uint16_t* dn =
            packet.dn.data() + index(array_.planes) * count_due(schedule, slot, packet.first_row,
                                                                begin - packet.first_row,
                                                                array_.cols);
        for (int row = begin; row < end; ++row)
            visit_due_pixels(schedule, slot, row, array_.cols, [&](int col, const DuePixel& pixel) {
                place(part, {packet.slot, row, col}, {dn, pixel});
                dn += array_.planes;
            });
    }

  private:
    struct Sample {
        const std::uint16_t* dn;  ///< one for each plane
        DuePixel pixel;
    };

    /// A sample of a part of the schedule, read at the end of a slot.
    void place(std::size_t part, const PixelSlot& at, const Sample& sample) {
        const auto [last_slot, row, col] = at;
        const int window_row = row - window_.first_row;
        const int window_col = col - window_.first_col;
        if (window_col < 0 || window_col >= window_.shape.cols) return;
        const Span span = span_of(part, at, sample.pixel);
        const std::int64_t begin = last_slot - span.slots + 1;
        const std::int64_t first = begin - window_.first_slot;
        if (span.slots == 0 || first < 0) return;
        const Responses& responses = responses_[part - first_part_];
        const auto sites = window_.shape.sites();
        const int first_plane = cfa_ == ColourFilter::kNone ? 0 : colour_plane(cfa_, row, col);
        auto voxel = index(first) * sites + index(first_plane) * window_.shape.pixels() +
                     row_major(window_row, window_col, window_.shape.cols);
        for (int plane = 0; plane < array_.planes; ++plane, voxel += window_.shape.pixels()) {
            if (responses.same) {
                write(voxel, sample.dn[plane], span, *responses.same);
                continue;
            }
            const PixelResponse response = responses.of_sites.at(plane, row, col);
            if (!response.defect()) write(voxel, sample.dn[plane], span, response);
        }
        if (schedule_.weighted()) write_weights(index(first), span, {begin, row, col});
    }

    struct Span {
        std::uint64_t open_slots;
        int slots;                ///< 0 if unknown
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

    /// `first` is the slot of the window in which the exposure begins, at.slot that of the stream.
    void write_weights(std::size_t first, const Span& span, const PixelSlot& at) {
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

    [[nodiscard]] Span span_of(std::size_t part, const PixelSlot& at, const DuePixel& pixel) const {
        const ExposureSchedule& schedule = *parts_[part].schedule;
        const std::int64_t period = schedule.period_slots();
        // After a period each pixel has been read since the switch.
        if (part > 0 && at.slot < parts_[part].first_slot + period) {
            const auto read = read_exposure(parts_, at);
            if (!read) return {};
            return {read->open_slots, static_cast<int>(std::bit_width(read->open_slots)),
                    std::popcount(read->open_slots), Measurements::kOpen};
        }
        if (pixel.light_slots == pixel.span_slots && !out_.interleaved)  // most, without a search
            return {open_without_gap(pixel.span_slots), pixel.span_slots, pixel.light_slots,
                    Measurements::kOpen};
        const std::int64_t begin = at.slot - pixel.span_slots + 1;  // 0 or more, or it were not due
        const int tile_row = at.row % schedule.tile_rows();
        const int tile_col = at.col % schedule.tile_cols();
        const std::size_t i = exposure_starting_at(schedule, tile_row, tile_col, begin);
        const std::uint64_t open_slots = schedule.exposures(tile_row, tile_col)[i].open_slots;
        const bool second = schedule.store(tile_row, tile_col, i, begin / period) != 0;
        const int open_state = Measurements::kOpen | (second ? Measurements::kSecond : 0);
        return {open_slots, pixel.span_slots, pixel.light_slots,
                static_cast<std::uint8_t>(open_state)};
    }

    const ExposureSchedule& schedule_;  ///< the first one, which alone may have weights
    std::vector<SchedulePart> parts_;
    FrameShape array_;
    ColourFilter cfa_;
    std::size_t first_part_;            ///< of the window
    std::vector<Responses> responses_;  ///< of this part and the later ones in the window
    VideoWindow window_;
    Measurements& out_;
};

/// True if the readouts of a window do not all have the same values.
bool readout_changes(const StreamHeader& header, const VideoWindow& window) {
    const ReadoutValues first = readout_values(calibration_at(header, window.first_slot));
    return std::ranges::any_of(header.switches, [&](const ScheduleSwitch& part) {
        return part.slot > window.first_slot && part.slot < window.first_slot + window.slots &&
               part.values != first;
    });
}

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
        !header.sites.empty() || readout_changes(header, window)) {
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
