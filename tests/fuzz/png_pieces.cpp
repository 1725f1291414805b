#include "tests/fuzz/png_pieces.h"

#include <algorithm>

#include "capture/serve/big_endian.h"

namespace stipple {
namespace {

using View = std::span<const std::uint8_t>;

constexpr std::size_t kSignatureBytes = 8;
constexpr std::size_t kHeadBytes = 8;  ///< length and type of a chunk
constexpr std::size_t kCrcBytes = 4;   ///< the end of its body

std::vector<Piece> cut(View bytes) {
    if (bytes.size() < kSignatureBytes) return {};
    std::vector<Piece> pieces{{{bytes.begin(), bytes.begin() + kSignatureBytes}, {}}};
    for (View rest = bytes.subspan(kSignatureBytes); !rest.empty();
         rest = rest.subspan(pieces.back().size())) {
        const std::size_t head = std::min(rest.size(), kHeadBytes);
        const std::size_t wanted =
            head < kHeadBytes ? 0 : std::size_t{load_be<std::uint32_t>(rest.data())} + kCrcBytes;
        const std::size_t body = std::min(rest.size() - head, wanted);
        pieces.push_back({{rest.begin(), rest.begin() + static_cast<std::ptrdiff_t>(head)},
                          {rest.begin() + static_cast<std::ptrdiff_t>(head),
                           rest.begin() + static_cast<std::ptrdiff_t>(head + body)}});
    }
    return pieces;
}

void store_be(std::uint8_t* bytes, std::size_t value) {
    for (int i = 0; i < 4; ++i) bytes[i] = static_cast<std::uint8_t>(value >> (24 - 8 * i));
}

/// CRC-32 of ISO 3309, bit by bit.
std::uint32_t crc32(std::uint32_t crc, View bytes) {
    crc = ~crc;
    for (const std::uint8_t byte : bytes) {
        crc ^= byte;
        for (int bit = 0; bit < 8; ++bit) crc = crc >> 1U ^ (0xEDB88320U & (0U - (crc & 1U)));
    }
    return ~crc;
}

void mend(std::vector<Piece>& pieces, Dice& /*dice*/) {
    for (Piece& piece : pieces) {
        auto& [head, body] = piece;
        if (head.size() != kHeadBytes || &piece == &pieces.front()) continue;
        body.resize(std::max(body.size(), kCrcBytes));
        const std::size_t data = body.size() - kCrcBytes;
        store_be(head.data(), data);
        store_be(&body[data], crc32(crc32(0, View(head).last(4)), View(body).first(data)));
    }
}

}  // namespace

const FramedFormat kPngFormat{cut, mend};

}  // namespace stipple
