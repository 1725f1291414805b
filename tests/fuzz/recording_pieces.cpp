#include "tests/fuzz/recording_pieces.h"

#include <algorithm>

#include "capture/frame_payload.h"
#include "capture/recording/recording_format.h"
#include "stream/crc32c.h"
#include "stream/little_endian.h"

namespace stipple {
namespace {

using View = std::span<const std::uint8_t>;

constexpr std::size_t kFrameHeadBytes = kBlockHeaderBytes + kFrameRecordBytes;

bool begins_block(View bytes) {
    return bytes.size() >= kBlockHeaderBytes &&
           std::equal(kBlockSync.begin(), kBlockSync.end(), bytes.begin());
}

bool is_frame(View head) {
    return load<std::uint32_t>(&head[4]) == static_cast<std::uint32_t>(BlockKind::kFrame);
}

/// Of the block or other bytes that `rest` begins with. The fixed record of a frame is head.
Piece next_piece(View rest) {
    std::size_t head = 0;
    std::size_t length = 1;
    if (begins_block(rest)) {
        const std::size_t record = load<std::uint32_t>(&rest[12]);
        const auto payload = load<std::uint64_t>(&rest[16]);
        const std::size_t room = rest.size() - kBlockHeaderBytes;
        if (record <= room && payload <= room - record) {
            head =
                is_frame(rest) && record >= kFrameRecordBytes ? kFrameHeadBytes : kBlockHeaderBytes;
            length = kBlockHeaderBytes + record + payload;
        }
    }
    while (head == 0 && length < rest.size() && !begins_block(rest.subspan(length))) ++length;
    const auto begin = rest.begin() + static_cast<std::ptrdiff_t>(head);
    return {{rest.begin(), begin}, {begin, rest.begin() + static_cast<std::ptrdiff_t>(length)}};
}

std::vector<Piece> cut(View bytes) {
    if (bytes.size() < kRecordingMagic.size()) return {};
    std::vector<Piece> pieces{{{bytes.begin(), bytes.begin() + kRecordingMagic.size()}, {}}};
    for (View rest = bytes.subspan(kRecordingMagic.size()); !rest.empty();
         rest = rest.subspan(pieces.back().size()))
        pieces.push_back(next_piece(rest));
    return pieces;
}

/// The payload of a frame takes what its body has besides the holes, the record of another all.
void mend_block(Piece& block) {
    const bool frame = block.head.size() == kFrameHeadBytes && is_frame(block.head);
    std::size_t holes = 0;
    if (frame) {
        holes = kHoleBytes * load<std::uint32_t>(&block.head[kBlockHeaderBytes + 116]);
        if (holes > block.body.size()) holes = 0;
    }
    const View body(block.body);
    const View payload = frame ? body.subspan(holes) : View{};
    if (frame)
        store_payload_hash(std::span(block.head).subspan(kBlockHeaderBytes), payload_hash(payload));
    Bytes record(block.head.begin() + kBlockHeaderBytes, block.head.end());
    const View rest = body.first(body.size() - payload.size());
    record.insert(record.end(), rest.begin(), rest.end());
    store(&block.head[12], static_cast<std::uint32_t>(record.size()));
    store(&block.head[16], std::uint64_t{payload.size()});
    store(&block.head[24], crc32c(record));
    store(&block.head[28], crc32c(View(block.head).first(28)));
}

void mend(std::vector<Piece>& pieces, Dice& dice) {
    const bool numbered = dice() % 4 != 0;
    std::uint32_t number = 0;
    for (Piece& piece : pieces) {
        if (!begins_block(piece.head)) continue;
        if (numbered) store(&piece.head[8], number++);
        mend_block(piece);
    }
}

}  // namespace

const FramedFormat kRecordingFormat{cut, mend};

}  // namespace stipple
