#include <algorithm>
#include <array>
#include <utility>

#include "tests/fuzz/framed_file.h"

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t most);

namespace stipple {
namespace {

constexpr std::size_t kMaxPieces = 256;
constexpr std::size_t kMaxGrowth = 256;  ///< of a body in one step

/// 0 .. below - 1.
std::size_t roll(Dice& dice, std::size_t below) {
    return dice() % below;
}

/// One of the numbers at which programs break, or one near the old one.
std::uint64_t other_number(std::uint64_t number, std::size_t bits, Dice& dice) {
    const std::uint64_t top = std::uint64_t{1} << (bits - 1);
    switch (roll(dice, 8)) {
        case 0:
            return 0;
        case 1:
            return top + roll(dice, 3) - 1;
        case 2:
            return ~std::uint64_t{0};
        case 3:
            return std::uint64_t{1} << roll(dice, bits);
        case 4:
            return number ^ std::uint64_t{1} << roll(dice, bits);
        case 5:
            return roll(dice, 256);
        default:
            return number + roll(dice, 33) - 16;
    }
}

/// A little-endian number of 1, 2, 4 or 8 bytes, which may as well be a big-endian one or text.
void change_number(std::span<std::uint8_t> bytes, Dice& dice) {
    if (bytes.empty()) return;
    const std::size_t width = std::min(std::size_t{1} << roll(dice, 4), bytes.size());
    const std::size_t at = roll(dice, bytes.size() / width) * width;
    std::uint64_t number = 0;
    for (std::size_t i = 0; i < width; ++i) number |= std::uint64_t{bytes[at + i]} << 8 * i;
    number = other_number(number, 8 * width, dice);
    const bool big_endian = roll(dice, 4) == 0;
    for (std::size_t i = 0; i < width; ++i)
        bytes[at + (big_endian ? width - 1 - i : i)] = static_cast<std::uint8_t>(number >> 8 * i);
}

void change_body(Bytes& body, Dice& dice) {
    const std::size_t size = body.size();
    body.resize(size + 1 + roll(dice, kMaxGrowth));
    const bool grows = size == 0 || roll(dice, 2) == 0;
    body.resize(LLVMFuzzerMutate(body.data(), size, grows ? body.size() : size));
}

void change_one(std::vector<Piece>& pieces, Dice& dice) {
    const std::size_t at = roll(dice, pieces.size());
    Piece& piece = pieces[at];
    const auto here = pieces.begin() + static_cast<std::ptrdiff_t>(at);
    switch (roll(dice, 8)) {
        case 0:
            if (pieces.size() < kMaxPieces) pieces.insert(here, Piece(piece));
            return;
        case 1:
            if (pieces.size() > 1) pieces.erase(here);
            return;
        case 2:
            std::swap(piece, pieces[roll(dice, pieces.size())]);
            return;
        case 3:
        case 4:
            return change_number(piece.head, dice);
        case 5:
            return change_number(piece.body, dice);
        default:
            return change_body(piece.body, dice);
    }
}

}  // namespace

std::size_t mutate_framed(const FramedFormat& format, std::span<std::uint8_t> data,
                          std::size_t size, unsigned seed) {
    Dice dice(seed);
    std::vector<Piece> pieces = format.cut(data.first(size));
    if (pieces.empty() || roll(dice, 8) == 0)
        return LLVMFuzzerMutate(data.data(), size, data.size());
    for (std::size_t changes = 1 + roll(dice, 4); changes > 0; --changes) change_one(pieces, dice);
    format.mend(pieces, dice);
    const Bytes bytes = join(pieces);
    if (bytes.size() > data.size()) return LLVMFuzzerMutate(data.data(), size, data.size());
    std::copy(bytes.begin(), bytes.end(), data.begin());
    return bytes.size();
}

}  // namespace stipple
