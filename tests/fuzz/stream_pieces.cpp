#include "tests/fuzz/stream_pieces.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <optional>

#include "core/error.h"
#include "stream/bit_packing.h"
#include "stream/crc32c.h"
#include "stream/header_codec.h"
#include "stream/little_endian.h"
#include "stream/packet_codec.h"
#include "stream/slot_index.h"

namespace stipple {
namespace {

using View = std::span<const std::uint8_t>;

constexpr std::size_t kCrcBytes = 4;
constexpr std::size_t kMaxPixels = 1 << 14;  ///< of an array whose samples are made up
constexpr std::uint32_t kPacketSync = 0x4B5053C5;
constexpr std::uint32_t kEndSync = 0x444E45C5;

std::uint32_t sync_of(View bytes) {
    return bytes.size() < 4 ? 0 : load<std::uint32_t>(bytes.data());
}

Piece piece_of(View bytes, std::size_t head, std::size_t body) {
    const auto at = bytes.begin();
    const auto begin = at + static_cast<std::ptrdiff_t>(head);
    return {{at, begin}, {begin, begin + static_cast<std::ptrdiff_t>(body)}};
}

/// Of the packet, end marker or other bytes that `rest` begins with.
Piece next_piece(View rest, std::size_t marker_bytes) {
    if (sync_of(rest) == kEndSync && rest.size() >= marker_bytes)
        return piece_of(rest, marker_bytes, 0);
    if (sync_of(rest) == kPacketSync && rest.size() >= kPacketHeaderBytes) {
        const std::size_t payload = load<std::uint32_t>(&rest[24]);
        if (payload <= rest.size() - kPacketHeaderBytes)
            return piece_of(rest, kPacketHeaderBytes, payload);
    }
    std::size_t length = 1;
    while (length < rest.size() && sync_of(rest.subspan(length)) != kPacketSync &&
           sync_of(rest.subspan(length)) != kEndSync)
        ++length;
    return piece_of(rest, 0, length);
}

std::vector<Piece> cut(View bytes) {
    if (bytes.size() < kStreamHeadBytes + kCrcBytes) return {};
    const std::size_t header = load<std::uint32_t>(&bytes[12]);
    if (header < kStreamHeadBytes + kCrcBytes || header > bytes.size()) return {};
    std::vector<Piece> pieces{piece_of(bytes, kStreamHeadBytes, header - kStreamHeadBytes)};
    const std::size_t marker = bytes[8] == 1 ? 16 : kEndMarkerBytes;
    for (View rest = bytes.subspan(header); !rest.empty();
         rest = rest.subspan(pieces.back().size()))
        pieces.push_back(next_piece(rest, marker));
    return pieces;
}

bool is_packet(const Piece& piece) {
    return piece.head.size() == kPacketHeaderBytes && sync_of(piece.head) == kPacketSync;
}

/// What the generator makes of a section of kind "random", if it can and that is little.
std::optional<std::uint32_t> random_crc(const Bytes& head, View section) {
    const int rows = load<std::uint16_t>(&head[16]);
    const int cols = load<std::uint16_t>(&head[18]);
    if (head[84] != 1 || section.size() < 10 || section.size() != 9U + section[8] || rows == 0 ||
        cols == 0 || asks_for_much(head))
        return {};
    const std::vector<int> lengths(section.begin() + 9, section.end());
    if (!std::ranges::all_of(lengths, [](int slots) { return slots >= 1 && slots <= 64; }))
        return {};
    return schedule_crc(random_schedule(rows, cols, lengths, load<std::uint64_t>(section.data())));
}

/// Lengths and CRCs of the header. What its body has grown by is the schedule's.
void mend_header(Piece& header) {
    Bytes& head = header.head;
    Bytes& body = header.body;
    if (head.size() != kStreamHeadBytes) return;
    body.resize(std::max(body.size(), kCrcBytes));
    const std::size_t texts =
        std::size_t{load<std::uint32_t>(&head[72])} + load<std::uint32_t>(&head[76]);
    const std::size_t sections = body.size() - kCrcBytes;
    store(&head[12], static_cast<std::uint32_t>(kStreamHeadBytes + body.size()));
    if (texts <= sections) {
        if (head[85] == 0 && head[86] == 0)
            store(&head[80], static_cast<std::uint32_t>(sections - texts));
        const std::size_t bytes = load<std::uint32_t>(&head[80]);
        if (texts + bytes <= sections) {
            const View section = View(body).subspan(texts, bytes);
            const auto crc = head[84] == 0 ? crc32c(section) : random_crc(head, section);
            if (crc) store(&head[88], *crc);
        }
    }
    const std::uint32_t crc = crc32c(View(body).first(sections), crc32c(head));
    store(&body[sections], crc);
}

/// Gives each packet the samples that are due in its slot, slot after slot, if the header is good.
void fill_slots(std::vector<Piece>& pieces) {
    const Bytes bytes = join({pieces.front()});
    if (bytes.size() < kStreamHeadBytes || asks_for_much(bytes)) return;
    std::optional<StreamHeader> header;
    try {
        header = decode_header(bytes, "fuzz");
    } catch (const InputError&) {
        return;
    }
    const auto& [rows, cols, planes] = header->shape;
    if (header->shape.pixels() > kMaxPixels || header->may_switch) return;
    const int depth = header->calibration.bit_depth;
    std::int64_t slot = 0;
    for (Piece& piece : pieces) {
        if (!is_packet(piece) || piece.head[4] != 1) continue;
        const bool dropped = (piece.head[5] & 2U) != 0;
        const std::size_t samples = dropped ? 0
                                            : static_cast<std::size_t>(planes) *
                                                  count_due(header->schedule, slot, 0, rows, cols);
        const std::size_t before = piece.body.size();
        piece.body.resize(packed_bytes(samples, depth));
        for (std::size_t i = before; i < piece.body.size() && before > 0; ++i)
            piece.body[i] = piece.body[i - before];
        const std::size_t used = samples * static_cast<std::size_t>(depth) % 8;
        if (used > 0) piece.body.back() &= static_cast<std::uint8_t>((1U << used) - 1);
        store(&piece.head[8], static_cast<std::uint64_t>(slot++));
        store(&piece.head[16], std::uint16_t{0});
        store(&piece.head[18], static_cast<std::uint16_t>(rows));
        store(&piece.head[20], static_cast<std::uint32_t>(samples));
    }
}

/// What the index must hold, up to its own piece.
void fill_index(const std::vector<Piece>& pieces, Piece& index) {
    std::vector<IndexEntry> entries, switches;
    std::uint64_t offset = 0;
    std::uint64_t slots = 0;
    for (const Piece& piece : pieces) {
        if (&piece == &index) break;
        if (is_packet(piece)) {
            const auto slot = load<std::uint64_t>(&piece.head[8]);
            const bool next = load<std::uint16_t>(&piece.head[6]) == switches.size() + 1;
            if (piece.head[4] == 4 && next) switches.push_back({slot, offset});
            if (piece.head[4] == 4) {
                offset += piece.size();
                continue;
            }
            if (entries.empty() || slot > entries.back().slot) entries.push_back({slot, offset});
            slots = slot + 1;
        }
        offset += piece.size();
    }
    store(&index.head[6], static_cast<std::uint16_t>(switches.size()));
    store(&index.head[8], slots);
    store(&index.head[20], static_cast<std::uint32_t>(entries.size()));
    entries.insert(entries.end(), switches.begin(), switches.end());
    index.body.resize(entries.size() * kIndexEntryBytes);
    store_index(entries, index.body);
}

void mend(std::vector<Piece>& pieces, Dice& dice) {
    mend_header(pieces.front());
    if (pieces.front().head.size() != kStreamHeadBytes) return;
    if (dice() % 2 == 0) fill_slots(pieces);
    const bool right_index = dice() % 2 == 0;
    const Framing framing = framing_of(join({pieces.front()}));
    std::uint32_t checksum = framing.seed;
    std::uint64_t offset = 0;
    std::uint64_t index_at = 0;
    for (Piece& piece : pieces) {
        Bytes& head = piece.head;
        if (is_packet(piece)) {
            if (head[4] == 3) index_at = offset;
            if (head[4] == 3 && right_index) fill_index(pieces, piece);
            store(&head[24], static_cast<std::uint32_t>(piece.body.size()));
            store(&head[28], crc32c(piece.body));
            store(&head[32], crc32c(View(head).first(32), framing.seed));
            checksum = add_to_checksum(checksum, head);
        } else if (sync_of(head) == kEndSync) {
            head.resize(end_marker_bytes(framing));
            if (right_index) store(&head[4], index_at);
            if (framing.version != 1) store(&head[12], checksum);
            const std::size_t crc = head.size() - kCrcBytes;
            store(&head[crc], crc32c(View(head).first(crc), framing.seed));
        }
        offset += piece.size();
    }
}

}  // namespace

bool asks_for_much(View bytes) {
    constexpr std::size_t kMaxSites = 4096;
    return (bytes[84] == 1 || bytes[8] == 4) &&
           std::size_t{load<std::uint16_t>(&bytes[16])} * load<std::uint16_t>(&bytes[18]) >
               kMaxSites;
}

const FramedFormat kStreamFormat{cut, mend};

}  // namespace stipple
