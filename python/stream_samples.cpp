#include "python/stream_samples.h"

#include <fmt/format.h>

#include <bit>
#include <span>
#include <utility>

#include "core/error.h"
#include "python/bindings.h"
#include "python/errors.h"
#include "stream/schedule_switch.h"

namespace stipple::python {
namespace {

/// The open slots of a due pixel, bit 0 the first one; 0 if that is unknown after a switch.
std::uint64_t open_slots_of(std::span<const SchedulePart> parts, const SchedulePart& part,
                            const PixelSlot& at, const DuePixel& pixel) {
    if (part.first_slot > 0) {
        const auto read = read_exposure(parts, at);
        return read ? read->open_slots : 0;
    }
    if (pixel.light_slots == pixel.span_slots) return open_without_gap(pixel.span_slots);
    const ExposureSchedule& schedule = *part.schedule;
    const int row = at.row % schedule.tile_rows(), col = at.col % schedule.tile_cols();
    const std::size_t i = exposure_starting_at(schedule, row, col, at.slot + 1 - pixel.span_slots);
    return schedule.exposures(row, col)[i].open_slots;
}

}  // namespace

void SampleRows::add(const SamplePacket& packet, const StreamHeader& header) {
    if (packet.dn.empty()) return;
    const auto parts = schedule_parts(header);
    const SchedulePart part = schedule_at(header, packet.slot);
    if (!responses_ || responses_begin_ != part.first_slot) {
        responses_begin_ = part.first_slot;
        responses_.emplace(calibration_at(header, packet.slot));
    }
    auto dn = packet.dn.begin();
    const std::int64_t slot = readout_slot(part, packet.slot);
    for (int row = packet.first_row; row < packet.first_row + packet.rows; ++row)
        visit_due_pixels(
            *part.schedule, slot, row, header.shape.cols, [&](int col, const DuePixel& pixel) {
                const std::uint64_t open_slots =
                    open_slots_of(parts, part, {packet.slot, row, col}, pixel);
                const PixelResponse& response = responses_->at(row, col);
                for (int plane = 0; plane < header.shape.planes; ++plane, ++dn)
                    rows_->push_back(
                        {.slot = packet.slot,
                         .row = static_cast<std::uint16_t>(row),
                         .col = static_cast<std::uint16_t>(col),
                         .plane = static_cast<std::uint8_t>(plane),
                         .exposure_slots = static_cast<std::uint8_t>(std::bit_width(open_slots)),
                         .light_slots = static_cast<std::uint8_t>(std::popcount(open_slots)),
                         .saturated = response.saturated(*dn),
                         .open_slots = open_slots,
                         .dn = *dn,
                         .zero = {}});
            });
}

py::array SampleRows::take() {
    auto rows = std::exchange(rows_, std::make_unique<std::vector<SampleRow>>());
    const py::capsule owner(
        rows.get(), [](void* memory) { delete static_cast<std::vector<SampleRow>*>(memory); });
    const auto size = static_cast<py::ssize_t>(rows->size());
    return py::array_t<SampleRow>(size, rows.release()->data(), owner);
}

SlotRange slots_in(const py::object& value, const char* argument) {
    const bool is_range = py::isinstance(value, py::module_::import("builtins").attr("range"));
    if (!is_range || !value.attr("step").equal(py::int_(1)))
        throw py::type_error(
            fmt::format("{}: {} is not range(first, end)", argument, short_text(value)));
    constexpr std::uint64_t kMax = std::uint64_t{1} << 53U;  // as of a stream
    const std::uint64_t first = whole_in(value.attr("start"), argument);
    const std::uint64_t end = whole_in(value.attr("stop"), argument);
    if (first >= end || end > kMax)
        throw InputError(argument, fmt::format("{} holds no slot", short_text(value)));
    return {static_cast<std::int64_t>(first), static_cast<std::int64_t>(end)};
}

void bind_sample_rows() {
    PYBIND11_NUMPY_DTYPE(SampleRow, slot, row, col, plane, exposure_slots, light_slots, saturated,
                         open_slots, dn);
}

}  // namespace stipple::python
