#include "view/recent_slots.h"

#include <algorithm>
#include <utility>

#include "core/index.h"
#include "decoder/measurements.h"
#include "stream/schedule_switch.h"
#include "study/report/report_page.h"
#include "view/mosaic_picture.h"

namespace stipple {
namespace {

constexpr std::size_t kLeastSlots = 48;
constexpr double kMaxBytes = 128 << 20U;

std::size_t slots_to_keep(const FrameLayout& layout, const StreamHeader& header) {
    const double samples =
        static_cast<double>(header.shape.sites()) * header.schedule.samples_per_pixel_slot();
    const double bytes = static_cast<double>(layout.payload_bytes()) + 2 * samples;
    return std::max(kLeastSlots, static_cast<std::size_t>(kMaxBytes / bytes));
}

FrameLayout with_rows(FrameLayout layout, int rows) {
    layout.height = rows;
    return layout;
}

/// light_code of a frame, coloured if `planes` are more than it has.
std::vector<std::uint16_t> codes_of(std::span<const std::uint8_t> payload, int planes,
                                    FrameLight& to_light) {
    std::vector<float> light(to_light.shape().sites());
    to_light.convert(payload, light);
    if (planes > to_light.shape().planes)
        light = coloured(light, to_light.shape(), to_light.filter());
    return light_codes(light);
}

}  // namespace

RecentSlots::RecentSlots(const FrameLayout& layout, double black_level_dn, StreamHeader header)
    : header_(std::make_shared<StreamHeader>(std::move(header))),
      layout_(layout),
      planes_(decoded_shape(*header_).planes),
      cell_rows_(std::min(layout.height, 2)),
      to_light_(layout, black_level_dn),
      cells_to_light_(with_rows(layout, cell_rows_), black_level_dn),
      most_(slots_to_keep(layout, *header_)) {}

void RecentSlots::add(std::span<const std::uint8_t> payload, std::span<const SamplePacket> packets,
                      std::int64_t arrival_ns) {
    Slot slot;
    const std::lock_guard lock(mutex_);
    if (slots_.size() == most_) {  // its memory is used again
        slot = std::move(slots_.front());
        slots_.pop_front();
    }
    if (payload.empty() && !slots_.empty()) payload = slots_.back().payload;
    slot.payload.assign(payload.begin(), payload.end());
    slot.packets.assign(packets.begin(), packets.end());
    slot.arrival_ns = arrival_ns;
    report_.packets += packets.size();
    for (const SamplePacket& packet : packets) report_.samples += packet.dn.size();
    slots_.push_back(std::move(slot));
    report_.slots = ++extent_.slots;
    extent_.first = extent_.slots - static_cast<std::int64_t>(slots_.size());
}

void RecentSlots::add(ScheduleSwitch next) {
    const std::lock_guard lock(mutex_);
    auto header = std::make_shared<StreamHeader>(*header_);
    // The slots that are there need none of the parts that ended long before them.
    while (!header->switches.empty() &&
           header->switches.front().slot + kMaxExposureSlots < extent_.first) {
        const ScheduleSwitch& first = header->switches.front();
        header->schedule = first.schedule;
        header->schedule_source = first.source;
        header->schedule_name = first.name;
        header->calibration = with_values(header->calibration, first.values);
        header->switches.erase(header->switches.begin());
    }
    header->switches.push_back(std::move(next));
    for (std::size_t i = 0; i < header->switches.size(); ++i)
        header->switches[i].number = static_cast<std::uint16_t>(i + 1);
    header_ = std::move(header);
}

std::shared_ptr<const StreamHeader> RecentSlots::header() const {
    const std::lock_guard lock(mutex_);
    return header_;
}

void RecentSlots::end() {
    const std::lock_guard lock(mutex_);
    extent_.complete = true;
}

SlotExtent RecentSlots::extent() const {
    const std::lock_guard lock(mutex_);
    return extent_;
}

StreamReport RecentSlots::report() const {
    const std::lock_guard lock(mutex_);
    return report_;
}

const RecentSlots::Slot* RecentSlots::find(std::int64_t slot) const {
    if (slot < extent_.first || slot >= extent_.slots) return nullptr;
    return &slots_[static_cast<std::size_t>(slot - extent_.first)];
}

std::shared_ptr<const StreamHeader> RecentSlots::visit(
    std::int64_t first, std::int64_t end,
    const std::function<void(const SamplePacket&)>& take) const {
    const std::lock_guard lock(mutex_);
    for (std::int64_t at = std::max(first, extent_.first); at < std::min(end, extent_.slots); ++at)
        for (const SamplePacket& packet : find(at)->packets) take(packet);
    return header_;
}

std::vector<std::uint8_t> RecentSlots::payload(std::int64_t slot, std::size_t first,
                                               std::size_t bytes) const {
    const std::lock_guard lock(mutex_);
    const Slot* const found = find(slot);
    if (found == nullptr) return {};
    const auto all = std::span(found->payload).subspan(std::min(first, found->payload.size()));
    const auto part = all.first(std::min(bytes, all.size()));
    return {part.begin(), part.end()};
}

std::vector<std::uint16_t> RecentSlots::codes(std::int64_t slot) {
    const auto frame = payload(slot, 0, layout_.payload_bytes());
    if (frame.empty()) return {};
    const std::lock_guard lock(light_mutex_);
    return codes_of(frame, planes_, to_light_);
}

std::optional<std::uint16_t> RecentSlots::code(std::int64_t slot, int plane, int row, int col) {
    const int first_row = std::max(std::min(row / 2 * 2, layout_.height - 2), 0);
    const auto cells = payload(slot, index(first_row) * layout_.stride_bytes,
                               index(cell_rows_) * layout_.stride_bytes);
    if (cells.empty()) return {};
    const std::lock_guard lock(light_mutex_);
    const auto codes = codes_of(cells, planes_, cells_to_light_);
    const FrameShape shape = cells_to_light_.shape();
    return codes[index(plane) * shape.pixels() + row_major(row - first_row, col, shape.cols)];
}

std::int64_t RecentSlots::arrival_ns(std::int64_t slot) const {
    const std::lock_guard lock(mutex_);
    const Slot* const found = find(slot);
    return found == nullptr ? 0 : found->arrival_ns;
}

}  // namespace stipple
