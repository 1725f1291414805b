#include "stream/stream_figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>

#include "core/message.h"

namespace stipple {

TileShape tile_shape_of(const StreamHeader& header) {
    if (header.schedule_source.kind == ScheduleSource::Kind::kRandom)
        return {header.shape.rows, header.shape.cols};
    return {header.schedule.tile_rows(), header.schedule.tile_cols()};
}

bool undamaged(const StreamReport& report) {
    return report.damage.empty() && report.missing_slots == 0 && report.tail_bytes == 0;
}

std::string damage_text(const StreamReport& report) {
    if (undamaged(report)) return {};
    if (report.damage.empty() && report.missing_slots == 0)
        return fmt::format(
            "the stream is cut off: {} slot{} are whole, then it ends within a packet, of which "
            "there are {} bytes",
            report.slots, report.slots == 1 ? "" : "s", report.tail_bytes);
    const std::uint64_t places = report.damage.size() + report.unlisted_damage;
    const std::size_t listed = std::min(report.damage.size(), kMaxShownFaults);
    std::string text = fmt::format("the stream is damaged; {} of {} slots are incomplete",
                                   report.missing_slots, report.slots);
    for (const StreamDamage& where : std::span(report.damage).first(listed))
        text += fmt::format("\n  byte {}: {}, {} bytes skipped", where.offset, where.cause,
                            where.bytes);
    if (places > listed) text += fmt::format("\n  and {} more", places - listed);
    if (report.tail_bytes > 0)
        text += fmt::format("\n  the file ends within a packet, its last {} bytes are unused",
                            report.tail_bytes);
    return text;
}

std::string decoded_damage_text(const StreamReport& report, std::string_view hint) {
    if (undamaged(report)) return {};
    return fmt::format("{}{}\n  the output contains the undamaged part", damage_text(report), hint);
}

std::string no_sample_text(const StreamReport& report) {
    return report.samples == 0 ? "holds no sample, so the frames are black" : "";
}

std::string no_end_text(const StreamReport& report) {
    if (report.complete || !undamaged(report)) return {};
    return "has no end marker: it was cut off, or is still being written";
}

}  // namespace stipple
