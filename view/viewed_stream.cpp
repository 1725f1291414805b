#include "view/viewed_stream.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "core/error.h"
#include "core/index.h"
#include "core/parallel.h"
#include "stream/schedule_switch.h"
#include "study/report/stream_text.h"

namespace stipple {
namespace {

using nlohmann::ordered_json;

PixelArea whole(FrameShape shape) {
    return {.first_row = 0, .first_col = 0, .rows = shape.rows, .cols = shape.cols};
}

/// Whether an exposure of the pixel ends in a slot.
bool is_due(const ExposureSchedule& schedule, int row, int col, std::int64_t slot) {
    const int period = schedule.period_slots();
    return std::ranges::any_of(
        schedule.exposures(row % schedule.tile_rows(), col % schedule.tile_cols()),
        [&](const Exposure& exposure) {
            const std::int64_t last = std::int64_t{exposure.first_slot} + exposure.span_slots() - 1;
            return slot % period == last % period;
        });
}

}  // namespace

ViewedStream::ViewedStream(std::unique_ptr<PacketSource> source, std::string name)
    : source_(std::move(source)),
      name_(std::move(name)),
      header_(source_->header()),
      samples_(*header_, whole(header_->shape)) {
    if (header_->schedule.weighted())
        throw InputError(name_, "a page shows no grey masks; \"stipple decode\" takes this stream");
    samples_.add_kinds();
}

std::shared_ptr<const StreamHeader> ViewedStream::header() const {
    const std::lock_guard lock(mutex_);
    return source_->header();
}

SlotExtent ViewedStream::extent() {
    const std::lock_guard lock(mutex_);
    extent_ = source_->extent();
    return extent_;
}

ordered_json ViewedStream::json() {
    const std::int64_t known = slots();
    const std::lock_guard lock(mutex_);
    use(source_->header());
    ordered_json json = run_json(name_, *header_, source_->report(), known);
    json["samples"] = samples_.json();
    json["loads"] = nullptr;
    return json;
}

void ViewedStream::use(std::shared_ptr<const StreamHeader> header) {
    if (header == header_) return;
    header_ = std::move(header);
    samples_.use(*header_);
    samples_.add_kinds();
}

ViewedStream::Samples ViewedStream::read_samples(std::int64_t slot) {
    if (slot != held_slot_) {
        samples_.clear();
        std::vector<SamplePacket> packets;
        use(source_->visit(slot, slot + 1,
                           [&](const SamplePacket& packet) { packets.push_back(packet); }));
        for (const SamplePacket& packet : packets) samples_.add(packet);
        held_slot_ = extent_.complete ? slot : -1;  // else the rest of it may come
    }
    return {{samples_.kinds().begin(), samples_.kinds().end()},
            {samples_.dn().begin(), samples_.dn().end()}};
}

ViewedStream::Samples ViewedStream::samples(std::int64_t slot) {
    const std::lock_guard lock(mutex_);
    return read_samples(slot);
}

std::vector<std::uint16_t> ViewedStream::exposure_map(std::int64_t slot) const {
    const auto shared = header();
    const StreamHeader& header = *shared;
    const ExposureSchedule& schedule = *schedule_at(header, slot).schedule;
    const int period = schedule.period_slots();
    const auto phase = static_cast<int>(slot % period);
    std::vector<std::uint16_t> map(header.shape.pixels());
    parallel_for(0, header.shape.rows, [&](int row) {
        for (int col = 0; col < header.shape.cols; ++col)
            for (const Exposure& exposure :
                 schedule.exposures(row % schedule.tile_rows(), col % schedule.tile_cols())) {
                const int since = (phase - static_cast<int>(exposure.first_slot) + period) % period;
                if (since < exposure.span_slots() && (exposure.open_slots >> since & 1U) != 0)
                    map[row_major(row, col, header.shape.cols)] =
                        static_cast<std::uint16_t>(exposure.light_slots());
            }
    });
    return map;
}

ordered_json ViewedStream::samples_of_pixel(int row, int col, std::int64_t first,
                                            std::int64_t end) {
    const std::lock_guard lock(mutex_);
    const auto header = source_->header();
    const FrameShape shape = header->shape;
    const std::size_t pixel = row_major(row, col, shape.cols);
    ordered_json list = ordered_json::array();
    for (std::int64_t slot = first; slot < end; ++slot) {
        if (!is_due(*schedule_at(*header, slot).schedule, row, col, slot)) continue;
        const Samples at = read_samples(slot);
        if (at.kinds[pixel] == 0) continue;
        const auto before = static_cast<std::size_t>(
            std::count_if(at.kinds.begin(), at.kinds.begin() + static_cast<std::ptrdiff_t>(pixel),
                          [](std::uint16_t kind) { return kind != 0; }));
        const auto planes = static_cast<std::size_t>(shape.planes);
        ordered_json dn = ordered_json::array();
        for (std::size_t i = 0; i < planes; ++i) dn.push_back(at.dn[before * planes + i]);
        list.push_back({slot, at.kinds[pixel] - 1, dn});
    }
    return list;
}

ViewedStream::Packets ViewedStream::packets(std::int64_t first, std::int64_t end) {
    const std::lock_guard lock(mutex_);
    Packets found;
    found.header = source_->visit(
        first, end, [&](const SamplePacket& packet) { found.packets.push_back(packet); });
    return found;
}

}  // namespace stipple
