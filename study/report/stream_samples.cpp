#include "study/report/stream_samples.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>
#include <span>
#include <string>

#include "core/error.h"
#include "core/exposure_schedule.h"
#include "decoder/pixel_response.h"
#include "stream/schedule_switch.h"
#include "study/report/report_page.h"
#include "study/report/schedule_text.h"

namespace stipple {
namespace {

using nlohmann::ordered_json;

/// The least DN that is saturated; full scale always is.
int saturated_dn(const PixelResponse& response, int bit_depth) {
    int low = 0;
    int high = (1 << bit_depth) - 1;
    while (low < high) {
        const int middle = (low + high) / 2;
        const bool saturated = response.saturated(static_cast<std::uint16_t>(middle));
        (saturated ? high : low) = saturated ? middle : middle + 1;
    }
    return low;
}

}  // namespace

ordered_json response_json(const PixelResponse& response, int bit_depth, int light_slots) {
    const int saturated = saturated_dn(response, bit_depth);
    const auto light = [&](int dn) {
        return static_cast<double>(response.light(static_cast<std::uint16_t>(dn), light_slots));
    };
    const int last = std::max(saturated - 1, 0);
    const double slope = last > 0 ? (light(last) - light(0)) / last : 0;
    const SampleNoise& noise = response.noise();
    return {
        {"zero", light(0)},
        {"per_dn", slope},
        {"saturated_dn", saturated},
        {"bound", light(saturated)},
        {"dark_variance", static_cast<double>(noise.variance(0)) +
                              light_slots * static_cast<double>(response.dark_variance_per_slot())},
        {"variance_per_light", static_cast<double>(noise.per_light())}};
}

SlotSamples::SlotSamples(const StreamHeader& header, const PixelArea& area)
    : header_(&header),
      area_(area),
      parts_(schedule_parts(header)),
      kinds_(static_cast<std::size_t>(area.rows) * static_cast<std::size_t>(area.cols)) {
    constexpr std::size_t kMaxPixels = 4096;
    if (header.calibration.tile.pixels.size() > kMaxPixels)
        throw InputError("calibration tile",
                         fmt::format("{} pixels that differ; a report shows at most {}",
                                     header.calibration.tile.pixels.size(), kMaxPixels));
}

void SlotSamples::use(const StreamHeader& header) {
    header_ = &header;
    parts_ = schedule_parts(header);
}

std::optional<std::uint64_t> SlotSamples::exposure_at(std::size_t part, const PixelSlot& at,
                                                      int span_slots) const {
    const auto& [schedule, first_slot, follows] = parts_[part];
    if (part > 0 && at.slot < first_slot + schedule->period_slots()) {
        const auto read = read_exposure(parts_, at);
        return read ? std::optional(read->open_slots) : std::nullopt;
    }
    const int tile_row = at.row % schedule->tile_rows(), tile_col = at.col % schedule->tile_cols();
    const std::size_t i =
        exposure_starting_at(*schedule, tile_row, tile_col, at.slot - span_slots + 1);
    return schedule->exposures(tile_row, tile_col)[i].open_slots;
}

std::size_t SlotSamples::readout_of(const SchedulePart& part) {
    const ReadoutValues values = readout_values(calibration_at(*header_, part.first_slot));
    const auto known = std::ranges::find(readouts_, values, &Readout::values);
    const auto at = static_cast<std::size_t>(known - readouts_.begin());
    if (known == readouts_.end()) readouts_.push_back({values, {}});
    return at;
}

std::uint16_t SlotSamples::kind_of(std::uint64_t open_slots, std::size_t readout) {
    const auto next = static_cast<std::uint16_t>(all_kinds_.size());
    const auto [kind, is_new] = readouts_[readout].kinds.try_emplace(open_slots, next);
    if (is_new) all_kinds_.push_back({open_slots, readout});
    if (all_kinds_.size() == std::numeric_limits<std::uint16_t>::max())
        throw InputError(
            "exposure schedule",
            "has too many kinds of exposures for a report; show a part with " + Parameter{"crop"});
    return kind->second;
}

void SlotSamples::add_kinds() {
    for (const SchedulePart& part : parts_) {
        const std::size_t readout = readout_of(part);
        const ExposureSchedule& schedule = *part.schedule;
        for (int row = 0; row < std::min(schedule.tile_rows(), header_->shape.rows); ++row)
            for (int col = 0; col < std::min(schedule.tile_cols(), header_->shape.cols); ++col)
                for (const Exposure& exposure : schedule.exposures(row, col))
                    (void)kind_of(exposure.open_slots, readout);
    }
}

void SlotSamples::add_row(const SamplePacket& packet, const PacketPart& of, int row,
                          const std::uint16_t*& dn) {
    const auto [part, readout] = of;
    const bool shown = row >= area_.first_row && row < area_.first_row + area_.rows;
    const int planes = header_->shape.planes;
    for_each_readout(
        *parts_[part].schedule, readout_slot(parts_[part], packet.slot), row, header_->shape.cols,
        [&, part = part, readout = readout](int col, int span_slots) {
            if (shown && col >= area_.first_col && col < area_.first_col + area_.cols) {
                const int pixel = (row - area_.first_row) * area_.cols + col - area_.first_col;
                if (const auto read = exposure_at(part, {packet.slot, row, col}, span_slots)) {
                    kinds_[static_cast<std::size_t>(pixel)] =
                        static_cast<std::uint16_t>(1 + kind_of(*read, readout));
                    dn_.insert(dn_.end(), dn, dn + planes);
                }
            }
            dn += planes;
        });
}

void SlotSamples::add(const SamplePacket& packet) {
    if (packet.dn.empty()) return;
    const std::size_t part = part_at(parts_, packet.slot);
    const PacketPart of{part, readout_of(parts_[part])};
    const std::uint16_t* dn = packet.dn.data();
    for (int row = packet.first_row; row < packet.first_row + packet.rows; ++row)
        add_row(packet, of, row, dn);
}

void SlotSamples::clear() {
    std::ranges::fill(kinds_, std::uint16_t{0});
    dn_.clear();
}

void StreamSamples::add(const SamplePacket& packet) {
    if (packet.slot != slot_) finish();
    slot_ = packet.slot;
    samples_.add(packet);
}

void StreamSamples::finish() {
    if (samples_.dn().empty()) return;
    planes_.push_back({fmt::format("k-{}", slot_), packed_plane(samples_.kinds())});
    planes_.push_back({fmt::format("d-{}", slot_), packed_plane(samples_.dn(), step_)});
    for (const PackedPlane& plane : std::span(planes_).last(2))
        bytes_ += plane.text.size() + kPlaneTagBytes;
    samples_.clear();
}

ordered_json SlotSamples::json() const {
    const CalibrationTile& tile = header_->calibration.tile;
    const int rows = tile.pixels.empty() ? 1 : tile.rows;
    const int cols = tile.pixels.empty() ? 1 : tile.cols;
    ordered_json exposures = ordered_json::array(), responses = ordered_json::array();
    std::set<int> lengths;
    for (const auto& [open_slots, readout] : all_kinds_) {
        exposures.push_back({{"span_slots", std::bit_width(open_slots)},
                             {"light_slots", std::popcount(open_slots)},
                             {"open", open_runs_json(open_slots)},
                             {"readout", readout}});
        lengths.insert(std::popcount(open_slots));
    }
    for (const Readout& readout : readouts_) {
        const Calibration calibration = with_values(header_->calibration, readout.values);
        const PixelResponses all(calibration);
        ordered_json of_pixels = ordered_json::array();
        for (int row = 0; row < rows; ++row)
            for (int col = 0; col < cols; ++col) {
                auto of_pixel = ordered_json::object();
                for (const int length : lengths)
                    of_pixel[std::to_string(length)] =
                        response_json(all.at(row, col), calibration.bit_depth, length);
                of_pixels.push_back(of_pixel);
            }
        responses.push_back(of_pixels);
    }
    return {{"exposures", exposures},
            {"response_rows", rows},
            {"response_cols", cols},
            {"responses", responses}};
}

}  // namespace stipple
