#include "stream/stream_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <limits>
#include <utility>

#include "core/error.h"
#include "stream/bit_packing.h"
#include "stream/buffered_reader.h"
#include "stream/crc32c.h"
#include "stream/packet_codec.h"
#include "stream/packet_order.h"
#include "stream/schedule_switch.h"
#include "stream/slot_index.h"
#include "stream/stream_opening.h"
#include "stream/switch_track.h"

namespace stipple {
namespace {

using Bytes = std::span<const std::uint8_t>;

constexpr std::size_t kSearchBytes = std::size_t{1} << 16U;
constexpr std::string_view kOtherPackets =
    "the packets are not those that were recorded, though each is good (checksum of all packets)";
constexpr std::uint64_t kMaxRescanBytes = std::uint64_t{1} << 32U;

}  // namespace

struct StreamReader::Impl {
    Impl(const std::filesystem::path& file, ReadPolicy read_policy, WaitForMore wait_for_more)
        : where(file.string()),
          strict(read_policy == ReadPolicy::kStrict),
          any_schedule(read_policy == ReadPolicy::kAnySchedule),
          wait(std::move(wait_for_more)),
          window(file,
                 wait ? BufferedReader::EmptyPipe::kReturn : BufferedReader::EmptyPipe::kWait),
          input_bytes(bytes_of(window, wait)),
          stream(open_stream_header(window, where, read_policy, wait)),
          switches(stream, where, input_bytes),
          slots(slots_by_index(window, stream.framing)),
          first_packet(window.offset()),
          order(stream.header.shape.rows),
          checksum(stream.framing.seed) {
        report.version = stream.framing.version;
    }

    enum class Step { kDelivered, kGoOn, kStop };

    /// One step over the file: a packet, an end marker, or the beginning of a search.
    Step step(SamplePacket& packet);
    Step take_packet(const PacketHeader& found, SamplePacket& packet);
    void deliver(const PacketHeader& found, Bytes payload, SamplePacket& packet);
    void take_index(const PacketHeader& found);
    void take_end_marker(const EndMarker& marker);
    /// The file ends within the packet that begins here; `tail` is there.
    Step wait_for_rest(Bytes tail);
    /// Moves to the next good start. False if there is none yet.
    bool search();
    /// At the end of what there is of the file: true if it is to be looked at again.
    bool more_comes();
    void count_bytes_after_end();
    /// Nothing for a good packet; one of a switch is taken.
    [[nodiscard]] std::optional<PacketFault> fault_of(const PacketHeader& found, Bytes payload);
    [[nodiscard]] std::optional<PacketFault> index_fault_of(const PacketHeader& found,
                                                            Bytes payload) const;

    /// Strict: throws. Tolerant: reports it.
    void note(std::uint64_t bytes, std::string_view cause);
    void begin_search(std::string_view cause);
    void limit_rescans(std::size_t payload_bytes);
    void extend_damage(std::uint64_t begin, std::uint64_t end);
    void skip_to(StreamPosition position);
    /// Forgets what was read after the header.
    void begin_at(IndexEntry place);

    std::string where;
    bool strict;
    bool any_schedule;
    WaitForMore wait;  ///< empty if the file is not followed, or no longer
    BufferedReader window;
    std::uint64_t input_bytes;
    StreamOpening stream;
    SwitchTrack switches;
    std::optional<std::int64_t> slots;
    std::uint64_t first_packet;  ///< its offset
    SlotIndex seen;              ///< the slots that were read, up to the last one so far
    PacketOrder order;
    StreamReport report;
    std::optional<std::uint64_t> search_begin;  ///< set while searching
    std::uint64_t searched_to = 0;   ///< end of the tail that `wait_for_rest` has searched
    std::uint32_t checksum;          ///< of all packets with good CRCs so far
    bool sought = false;             ///< packets were left out, so the checksum is another one
    std::uint64_t rescan_bytes = 0;  ///< of payloads whose CRC was wrong
    std::optional<std::uint64_t> index_offset;  ///< of the index packet, once it was read
    std::optional<std::uint64_t> end_offset;    ///< after the end marker, once it was read
};

void StreamReader::Impl::note(std::uint64_t bytes, std::string_view cause) {
    if (strict) throw InputError(fmt::format("{}: byte {}", where, window.offset()), cause);
    if (report.damage.size() < StreamReport::kMaxListedDamage)
        report.damage.push_back({window.offset(), bytes, std::string(cause)});
    else
        ++report.unlisted_damage;
}

void StreamReader::Impl::begin_search(std::string_view cause) {
    note(0, cause);
    search_begin = window.offset();
    searched_to = 0;
    window.skip(1);
}

// Damaged packets may overlap, each header in the payload of the one before. What is left of an
// honest file does so now and then; a crafted one could make the work quadratic.
void StreamReader::Impl::limit_rescans(std::size_t payload_bytes) {
    rescan_bytes += payload_bytes;
    if (rescan_bytes / 16 > kMaxRescanBytes / 16 + window.offset())
        throw InputError(fmt::format("{}: byte {}", where, window.offset()),
                         "too many damaged packets overlap; get another copy of the file");
}

void StreamReader::Impl::extend_damage(std::uint64_t begin, std::uint64_t end) {
    // Damage that is not listed has none listed after it.
    if (report.unlisted_damage == 0) report.damage.back().bytes = end - begin;
}

bool StreamReader::Impl::search() {
    for (;;) {
        const Bytes bytes = window.peek(kSearchBytes);
        const std::size_t found = find_start(bytes, stream.framing);
        const bool at_end = bytes.size() < kSearchBytes;
        const std::uint64_t skipped_to = window.offset() + found;
        if (found < bytes.size()) {
            extend_damage(*search_begin, skipped_to);
            window.skip(found);
            search_begin.reset();
            return true;
        }
        // The last bytes may be the first of a header.
        window.skip(bytes.size() - std::min(bytes.size(), kPacketHeaderBytes - 1));
        if (at_end) {
            extend_damage(*search_begin, skipped_to);
            return false;
        }
    }
}

StreamReader::Impl::Step StreamReader::Impl::step(SamplePacket& packet) {
    const Bytes bytes = window.peek(kPacketHeaderBytes);
    report.tail_bytes = 0;
    if (bytes.empty()) return Step::kStop;
    const Start start = start_of(bytes, stream.framing);
    switch (start) {
        case Start::kPacket:
            return take_packet(decode_packet_header(bytes), packet);
        case Start::kEnd:
            take_end_marker(decode_end_marker(bytes, stream.framing));
            return Step::kGoOn;
        case Start::kCut:
            return wait_for_rest(bytes);
        default:
            begin_search(cause_of(start, stream.framing));
            return Step::kGoOn;
    }
}

StreamReader::Impl::Step StreamReader::Impl::wait_for_rest(Bytes tail) {
    if (strict && !wait)
        note(0, fmt::format("the file ends within a packet, after {} bytes of it", tail.size()));
    // A good header further on means that bytes of this packet are missing. What was searched at
    // an earlier call is not searched again, but for a header that was cut.
    const std::uint64_t cut_from =
        std::max(searched_to, window.offset() + kPacketHeaderBytes) - (kPacketHeaderBytes - 1);
    const std::size_t from = std::min<std::size_t>(tail.size(), cut_from - window.offset());
    searched_to = window.offset() + tail.size();
    const Bytes rest = tail.subspan(from);
    if (find_start(rest, stream.framing) < rest.size()) {
        begin_search("bytes of a packet are missing");
        return Step::kGoOn;
    }
    report.tail_bytes = tail.size();
    return Step::kStop;
}

StreamReader::Impl::Step StreamReader::Impl::take_packet(const PacketHeader& found,
                                                         SamplePacket& packet) {
    const std::size_t size = kPacketHeaderBytes + found.payload_bytes;
    const Bytes bytes = window.peek(size);
    if (bytes.size() < size) return wait_for_rest(bytes);
    const Bytes payload = bytes.subspan(kPacketHeaderBytes);
    if (crc32c(payload) != found.payload_crc) {
        begin_search("the payload of a packet is damaged (CRC mismatch)");
        limit_rescans(payload.size());
        return Step::kGoOn;
    }
    checksum = add_to_checksum(checksum, bytes);
    const auto fault = fault_of(found, payload);
    if (fault) {
        note(size, fault->text);
        if (fault->is_unexpected) ++report.unexpected_packets;
    } else if (found.kind == PacketKind::kIndex) {
        take_index(found);
    } else if (found.kind == PacketKind::kSamples) {
        deliver(found, payload, packet);
    }
    window.skip(size);
    return fault || found.kind != PacketKind::kSamples ? Step::kGoOn : Step::kDelivered;
}

std::optional<PacketFault> StreamReader::Impl::fault_of(const PacketHeader& found, Bytes payload) {
    if (index_offset) return PacketFault{"a packet after the index"};
    if (found.kind == PacketKind::kSamples) {
        auto fault = sample_fault(stream.header, found, payload, order.expected(),
                                  {any_schedule, switches.counts()});
        if (!fault && slots && found.slot >= static_cast<std::uint64_t>(*slots))
            fault = PacketFault{
                fmt::format("slot {} is not one of the {} in the index", found.slot, *slots)};
        return fault;
    }
    if (found.kind == PacketKind::kIndex) return index_fault_of(found, payload);
    auto fault = fmt::format("packets of kind {} are not supported", static_cast<int>(found.kind));
    if (found.kind != PacketKind::kSwitch || !stream.header.may_switch)
        return PacketFault{std::move(fault)};
    auto wrong = switches.take(found, payload, order.expected());
    return wrong ? std::optional(PacketFault{std::move(*wrong)}) : std::nullopt;
}

std::optional<PacketFault> StreamReader::Impl::index_fault_of(const PacketHeader& found,
                                                              Bytes payload) const {
    // After damage and gaps no offset is right, but the number of slots is.
    const StreamPosition end{static_cast<std::int64_t>(found.slot), 0};
    const bool intact = report.damage.empty() && end == order.expected();
    const auto before = intact ? window.offset() : std::numeric_limits<std::uint64_t>::max();
    const int known = stream.header.may_switch ? last_switch(stream.header) : kNoSwitches;
    auto fault = index_fault(found, payload, before, order.expected(), known);
    if (!fault && intact && found.switches > std::max(known, 0))
        fault = fmt::format("the index counts {} switches of the schedule", found.switches);
    if (!fault && intact)
        fault = wrong_entry(load_index(payload, found.switches), window, stream.framing);
    return fault ? std::optional(PacketFault{*fault}) : std::nullopt;
}

void StreamReader::Impl::skip_to(StreamPosition position) {
    if (position == order.expected()) return;
    note(0, order.missing_before(position));
    order.skip_to(position);
    report.missing_slots = order.missing_slots();
}

void StreamReader::Impl::deliver(const PacketHeader& found, Bytes payload, SamplePacket& packet) {
    packet.slot = static_cast<std::int64_t>(found.slot);
    packet.first_row = found.first_row;
    packet.rows = found.rows;
    packet.flags = found.flags;
    skip_to({packet.slot, packet.first_row});
    if (packet.first_row == 0) seen.add({found.slot, window.offset()});
    packet.dn.resize(found.samples);
    unpack_bits(payload, stream.header.calibration.bit_depth, packet.dn);
    order.advance(packet.rows);
    ++report.packets;
    report.samples += found.samples;
    report.payload_bits +=
        std::uint64_t{found.samples} * static_cast<unsigned>(stream.header.calibration.bit_depth);
    report.slots = packet.slot + 1;
}

void StreamReader::Impl::begin_at(IndexEntry place) {
    window.seek(place.offset);
    order = PacketOrder(stream.header.shape.rows);
    order.begin_at(static_cast<std::int64_t>(place.slot));
    report = {};
    report.version = stream.framing.version;
    search_begin.reset();
    searched_to = 0;
    checksum = stream.framing.seed;
    sought = place.slot > 0;
    index_offset.reset();
    end_offset.reset();
}

void StreamReader::Impl::take_index(const PacketHeader& found) {
    index_offset = window.offset();
    report.slots = static_cast<std::int64_t>(found.slot);
    skip_to({report.slots, 0});
}

void StreamReader::Impl::take_end_marker(const EndMarker& marker) {
    const std::size_t size = end_marker_bytes(stream.framing);
    if (report.damage.empty() && marker.index_offset != index_offset)
        note(size, "the end marker does not point to an index before it");
    else if (report.damage.empty() && !sought && marker.checksum.value_or(checksum) != checksum)
        note(0, kOtherPackets);
    window.skip(size);
    end_offset = window.offset();
    report.complete = true;
    if (!slots) slots = slots_by_index(window, stream.framing);
}

bool StreamReader::Impl::more_comes() {
    if (!wait) return false;
    if (!wait(window.bytes_read())) wait = {};  // one more look, for which the file ends here
    return true;
}

void StreamReader::Impl::count_bytes_after_end() {
    for (;;) {
        const Bytes bytes = window.peek(kSearchBytes);
        if (bytes.empty()) return;
        if (window.offset() == *end_offset) note(0, "bytes after the end marker");
        extend_damage(*end_offset, window.offset() + bytes.size());
        window.skip(bytes.size());
    }
}

StreamReader::StreamReader(const std::filesystem::path& file, ReadPolicy policy, WaitForMore wait)
    : impl_(std::make_unique<Impl>(file, policy, std::move(wait))) {}

StreamReader::~StreamReader() = default;
StreamReader::StreamReader(StreamReader&&) noexcept = default;
StreamReader& StreamReader::operator=(StreamReader&&) noexcept = default;

const StreamHeader& StreamReader::header() const {
    return impl_->stream.header;
}

const std::string& StreamReader::name() const {
    return impl_->where;
}

void StreamReader::use_name(std::string name) {
    impl_->where = std::move(name);
}

std::uint64_t StreamReader::input_bytes() const {
    return impl_->input_bytes;
}

void StreamReader::use_schedule(ExposureSchedule schedule) {
    assert(impl_->report.packets == 0);
    impl_->stream.header.schedule = std::move(schedule);
    impl_->stream.header.schedule_source = {};
    impl_->stream.counts.reset();
}

void StreamReader::use_sites(std::vector<SiteCalibration> sites, ResponseTable response) {
    assert(impl_->report.packets == 0);
    assert(sites.empty() || sites.size() == impl_->stream.header.shape.sites());
    assert(response.linear_dn.empty() ||
           response.linear_dn.size() ==
               std::size_t{1} << static_cast<unsigned>(impl_->stream.header.calibration.bit_depth));
    impl_->stream.header.sites = std::move(sites);
    impl_->stream.header.response = std::move(response);
}

void StreamReader::follow_switches() {
    impl_->switches.follow();
}

std::optional<std::int64_t> StreamReader::slots() const {
    return impl_->slots;
}

std::int64_t StreamReader::seek(std::int64_t slot) {
    if (impl_->wait || !impl_->window.file_bytes()) return 0;
    auto place = entry_before(impl_->window, impl_->stream.framing, slot);
    if (place && !impl_->switches.reach(*place, impl_->window)) place.reset();
    const auto seen = last_before(impl_->seen.entries(), slot);
    if (seen && (!place || seen->slot > place->begin.slot)) place = IndexPlace{*seen, {}};
    const IndexEntry begin = place ? place->begin : IndexEntry{0, impl_->first_packet};
    impl_->switches.forget_after(static_cast<std::int64_t>(begin.slot));
    impl_->begin_at(begin);
    return impl_->order.expected().slot;
}

bool StreamReader::next(SamplePacket& packet) {
    for (;;) {
        if (impl_->end_offset) {
            impl_->count_bytes_after_end();
            return false;
        }
        const bool found = !impl_->search_begin || impl_->search();
        const auto step = found ? impl_->step(packet) : Impl::Step::kStop;
        if (step == Impl::Step::kDelivered) return true;
        if (step == Impl::Step::kStop && !impl_->more_comes()) return false;
    }
}

const StreamReport& StreamReader::report() const {
    return impl_->report;
}

}  // namespace stipple
