#include "python/stream_samples.h"

#include <fmt/format.h>

#include <bit>
#include <map>
#include <memory>
#include <vector>

#include "core/error.h"
#include "core/index.h"
#include "core/memory_limit.h"
#include "core/parallel.h"
#include "decoder/pixel_response.h"
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

/// The samples of a packet, by `responses` of the part of the schedule that holds in its slot.
void fill(const StreamHeader& header, const SamplePacket& packet, const PixelResponses& responses,
          SampleRow* row) {
    const auto parts = schedule_parts(header);
    const SchedulePart part = schedule_at(header, packet.slot);
    const std::int64_t slot = readout_slot(part, packet.slot);
    auto dn = packet.dn.begin();
    const auto add = [&](const PixelSlot& at, std::uint64_t open_slots) {
        const PixelResponse& response = responses.at(at.row, at.col);
        for (int plane = 0; plane < header.shape.planes; ++plane, ++dn)
            *row++ = {.slot = packet.slot,
                      .row = static_cast<std::uint16_t>(at.row),
                      .col = static_cast<std::uint16_t>(at.col),
                      .plane = static_cast<std::uint8_t>(plane),
                      .exposure_slots = static_cast<std::uint8_t>(std::bit_width(open_slots)),
                      .light_slots = static_cast<std::uint8_t>(std::popcount(open_slots)),
                      .saturated = response.saturated(*dn),
                      .open_slots = open_slots,
                      .dn = *dn,
                      .zero = {}};
    };
    for (int y = packet.first_row; y < packet.first_row + packet.rows; ++y)
        visit_due_pixels(*part.schedule, slot, y, header.shape.cols,
                         [&](int col, const DuePixel& pixel) {
                             const PixelSlot at{packet.slot, y, col};
                             add(at, open_slots_of(parts, part, at, pixel));
                         });
}

}  // namespace

py::array sample_rows(const StreamHeader& header, std::span<const SamplePacket> packets,
                      const std::string& name) {
    std::map<std::int64_t, PixelResponses> responses;  // by first slot of their part
    std::vector<std::size_t> first{0};                 // row of each packet
    for (const SamplePacket& packet : packets) {
        first.push_back(first.back() + packet.dn.size());
        const std::int64_t begin = schedule_at(header, packet.slot).first_slot;
        if (!responses.contains(begin)) responses.emplace(begin, calibration_at(header, begin));
    }
    check_memory(first.back() * sizeof(SampleRow), name, "the samples");
    auto rows = std::make_unique_for_overwrite<SampleRow[]>(first.back());
    {
        const py::gil_scoped_release released;
        parallel_for(0, static_cast<int>(packets.size()), [&](int i) {
            const SamplePacket& packet = packets[index(i)];
            if (packet.dn.empty()) return;  // dropped
            fill(header, packet, responses.at(schedule_at(header, packet.slot).first_slot),
                 rows.get() + first[index(i)]);
        });
    }
    const py::capsule owner(rows.get(),
                            [](void* memory) { delete[] static_cast<SampleRow*>(memory); });
    return py::array_t<SampleRow>(static_cast<py::ssize_t>(first.back()), rows.release(), owner);
}

StreamSlots slots_in(const py::object& value, const char* argument) {
    const bool is_range = py::isinstance(value, py::module_::import("builtins").attr("range"));
    if (!is_range || !py::int_(1).equal(value.attr("step")))
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
