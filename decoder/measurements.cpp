#include "decoder/measurements.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cassert>

#include "core/error.h"
#include "core/exposure_schedule.h"
#include "core/index.h"
#include "core/parallel.h"
#include "decoder/pixel_response.h"
#include "stream/schedule_switch.h"

namespace stipple {
namespace {

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
                responses_.emplace_back(
                    header, readout_values(calibration_at(header, parts_[i].first_slot)));
    }

    void add(const SamplePacket& packet) {
        if (packet.slot < window_.first_slot || packet.slot >= window_.first_slot + window_.slots ||
            packet.dn.empty())
            return;
        const std::uint16_t* dn = packet.dn.data();
        const std::size_t i = part_at(parts_, packet.slot);
        const std::int64_t slot = readout_slot(parts_[i], packet.slot);
        for (int row = packet.first_row; row < packet.first_row + packet.rows; ++row)
            for_each_readout(*parts_[i].schedule, slot, row, array_.cols,
                             [&](int col, int span_slots) {
                                 place(i, {packet.slot, row, col}, {dn, span_slots});
                                 dn += array_.planes;
                             });
    }

  private:
    struct Sample {
        const std::uint16_t* dn;  ///< one for each plane
        int span_slots;
    };

    /// A sample of a part of the schedule, read at the end of a slot.
    void place(std::size_t part, const PixelSlot& at, const Sample& sample) {
        const auto [last_slot, row, col] = at;
        const int window_row = row - window_.first_row;
        const int window_col = col - window_.first_col;
        if (window_row < 0 || window_row >= window_.shape.rows || window_col < 0 ||
            window_col >= window_.shape.cols)
            return;
        const Span span = span_of(part, at, sample.span_slots);
        const std::int64_t first = last_slot - span.slots + 1 - window_.first_slot;
        if (span.slots == 0 || first < 0) return;
        const SiteResponses& responses = responses_[part - first_part_];
        const auto sites = window_.shape.sites();
        const int first_plane = cfa_ == ColourFilter::kNone ? 0 : colour_plane(cfa_, row, col);
        auto voxel = index(first) * sites + index(first_plane) * window_.shape.pixels() +
                     row_major(window_row, window_col, window_.shape.cols);
        for (int plane = 0; plane < array_.planes; ++plane, voxel += window_.shape.pixels()) {
            const PixelResponse response = responses.at(plane, row, col);
            if (!response.defect()) write(voxel, sample.dn[plane], span, response);
        }
        if (schedule_.weighted())
            write_weights(index(first), span, {last_slot - span.slots + 1, row, col});
    }

    struct Span {
        std::uint64_t open_slots;
        int slots;                ///< 0 if unknown
        std::uint8_t open_state;  ///< kOpen, and the chain
    };

    void write(std::size_t first_voxel, std::uint16_t dn, const Span& span,
               const PixelResponse& response) {
        const auto sites = window_.shape.sites();
        for (int i = 0; i < span.slots; ++i)
            if ((span.open_slots >> static_cast<unsigned>(i) & 1U) != 0)
                out_.state[first_voxel + index(i) * sites] = span.open_state;
        const std::size_t last_voxel = first_voxel + index(span.slots - 1) * sites;
        out_.state[first_voxel] |= Measurements::kFirst;
        out_.state[last_voxel] |= Measurements::kLast;
        if (response.saturated(dn)) out_.state[last_voxel] |= Measurements::kSaturated;
        if (dn == 0) out_.state[last_voxel] |= Measurements::kZero;
        const int open_slots = std::popcount(span.open_slots);
        out_.sum[last_voxel] = response.light(dn, open_slots);
        out_.variance[last_voxel] = response.noise().variance(out_.sum[last_voxel]);
        if (out_.dark_variance.empty()) return;
        out_.dark_variance[last_voxel] = response.dark_variance(dn, open_slots);
        out_.variance_per_light[last_voxel] = response.variance_per_light(out_.sum[last_voxel]);
        out_.variance[last_voxel] = out_.variance_at(last_voxel, out_.sum[last_voxel]);
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

    [[nodiscard]] Span span_of(std::size_t part, const PixelSlot& at, int span_slots) const {
        const ExposureSchedule& schedule = *parts_[part].schedule;
        const std::int64_t period = schedule.period_slots();
        // After a period each pixel has been read since the switch.
        if (part > 0 && at.slot < parts_[part].first_slot + period) {
            const auto read = read_exposure(parts_, at);
            if (!read) return {};
            return {read->open_slots, static_cast<int>(std::bit_width(read->open_slots)),
                    Measurements::kOpen};
        }
        const std::int64_t begin = at.slot - span_slots + 1;  // 0 or more, or it were not due
        const int tile_row = at.row % schedule.tile_rows();
        const int tile_col = at.col % schedule.tile_cols();
        const std::size_t i = exposure_starting_at(schedule, tile_row, tile_col, begin);
        const std::uint64_t open_slots = schedule.exposures(tile_row, tile_col)[i].open_slots;
        const bool second = schedule.store(tile_row, tile_col, i, begin / period) != 0;
        const int open_state = Measurements::kOpen | (second ? Measurements::kSecond : 0);
        return {open_slots, span_slots, static_cast<std::uint8_t>(open_state)};
    }

    const ExposureSchedule& schedule_;  ///< the first one, which alone may have weights
    std::vector<SchedulePart> parts_;
    FrameShape array_;
    ColourFilter cfa_;
    std::size_t first_part_;                ///< of the window
    std::vector<SiteResponses> responses_;  ///< of this part and the later ones in the window
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

Measurements collect_measurements(const StreamHeader& header, std::span<const SamplePacket> packets,
                                  const VideoWindow& window) {
    assert(window.shape.planes == decoded_shape(header).planes);
    if (header.schedule.charge_stores() > 2)
        throw InputError("exposure schedule",
                         fmt::format("{} exposures of a pixel are under way at once; this decoder "
                                     "follows two at most",
                                     header.schedule.charge_stores()));
    Measurements result{
        .slots = window.slots,
        .shape = window.shape,
        .state = std::vector<std::uint8_t>(window.voxels()),
        .sum = std::vector<float>(window.voxels()),
        .variance = std::vector<float>(window.voxels()),
        .interleaved = header.schedule.interleaved(),
        .mosaic = header.cfa != ColourFilter::kNone,
        .dark_variance = {},
        .variance_per_light = {},
    };
    const Calibration& calibration = header.calibration;
    if (calibration.dark_e_per_slot != 0 || !calibration.tile.pixels.empty() ||
        !header.sites.empty() || readout_changes(header, window)) {
        result.dark_variance.resize(window.voxels());
        result.variance_per_light.resize(window.voxels());
    }
    if (header.schedule.weighted()) result.weight.assign(window.voxels(), 1.0F);
    Collector collector(header, window, result);
    parallel_for(0, static_cast<int>(packets.size()),
                 [&](int i) { collector.add(packets[index(i)]); });
    return result;
}

}  // namespace stipple
