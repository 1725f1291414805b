#pragma once

#include <cstddef>
#include <cstdint>
#include <random>
#include <span>
#include <vector>

namespace stipple {

using Bytes = std::vector<std::uint8_t>;

/// A piece of a file, as its framing cuts it up: the fixed head, and what the head announces. What
/// is no piece has no head.
struct Piece {
    Bytes head;
    Bytes body;

    [[nodiscard]] std::size_t size() const { return head.size() + body.size(); }
};

using Dice = std::minstd_rand;

/// A format of pieces with lengths and checksums, which a change at random breaks.
struct FramedFormat {
    /// All bytes come back, in order; heads have the size of their kind.
    std::vector<Piece> (*cut)(std::span<const std::uint8_t> bytes);
    /// Makes lengths and checksums true; by chance more, or less.
    void (*mend)(std::vector<Piece>& pieces, Dice& dice);
};

[[nodiscard]] Bytes join(const std::vector<Piece>& pieces);

/// As LLVMFuzzerCustomMutator: mostly changes numbers in heads, bodies, and the order of pieces,
/// and mends the file, so that it reaches behind the checksums.
std::size_t mutate_framed(const FramedFormat& format, std::span<std::uint8_t> data,
                          std::size_t size, unsigned seed);

}  // namespace stipple
