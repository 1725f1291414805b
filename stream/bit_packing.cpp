#include "stream/bit_packing.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <utility>

#include "stream/little_endian.h"

namespace stipple {
namespace {

// Eight samples of D bits are D bytes. They are moved as two groups of four: a word with four
// 16-bit lanes <-> a word whose low 4 D bits hold the four samples side by side. All four lanes
// are moved at once by masks and shifts, which compilers turn into vector code.

template <int D>
constexpr std::uint64_t kLane = (std::uint64_t{1} << D) - 1;

template <int D>
std::uint64_t squeeze(std::uint64_t lanes) {
    std::uint64_t packed = 0;
    for (int lane = 0; lane < 4; ++lane)
        packed |= (lanes >> (lane * (16 - D))) & (kLane<D> << (lane * D));
    return packed;
}

template <int D>
std::uint64_t spread(std::uint64_t packed) {
    std::uint64_t lanes = 0;
    for (int lane = 0; lane < 4; ++lane)
        lanes |= (packed & (kLane<D> << (lane * D))) << (lane * (16 - D));
    return lanes;
}

std::uint64_t load_lanes(const std::uint16_t* dn) {
    std::uint64_t lanes;
    std::memcpy(&lanes, dn, sizeof lanes);
    return lanes;
}

void store_lanes(std::uint16_t* dn, std::uint64_t lanes) {
    std::memcpy(dn, &lanes, sizeof lanes);
}

// Writes D bytes, but as whole words: up to 7 bytes beyond them.
template <int D>
void pack_eight(const std::uint16_t* dn, std::uint8_t* packed) {
    const std::uint64_t low = squeeze<D>(load_lanes(dn));
    const std::uint64_t high = squeeze<D>(load_lanes(dn + 4));
    if constexpr (D % 2 == 0) {
        store(packed, low);
        store(packed + D / 2, high);
    } else if constexpr (D <= 8) {
        store(packed, low | high << (4 * D));
    } else {
        store(packed, low | high << (4 * D));
        store(packed + 8, high >> (64 - 4 * D));
    }
}

// Reads D bytes, but as whole words: up to 7 bytes beyond them.
template <int D>
void unpack_eight(const std::uint8_t* packed, std::uint16_t* dn) {
    store_lanes(dn, spread<D>(load<std::uint64_t>(packed)));
    // For odd D the second group begins in the middle of a byte.
    store_lanes(dn + 4, spread<D>(load<std::uint64_t>(packed + D / 2) >> (D % 2 * 4)));
}

// Groups of eight samples that can be moved as whole words inside `bytes` bytes.
template <int D>
std::size_t whole_groups(std::size_t samples, std::size_t bytes) {
    constexpr std::size_t kReach = D + 8;
    if (bytes < kReach) return 0;
    return std::min(samples / 8, (bytes - kReach) / D + 1);
}

template <int D>
void pack(std::span<const std::uint16_t> dn, std::span<std::uint8_t> packed) noexcept {
    const std::size_t groups = whole_groups<D>(dn.size(), packed.size());
    for (std::size_t g = 0; g < groups; ++g) pack_eight<D>(&dn[g * 8], &packed[g * D]);
    std::uint32_t pending = 0;
    int pending_bits = 0;
    std::size_t out = groups * D;
    for (const std::uint16_t value : dn.subspan(groups * 8)) {
        pending |= std::uint32_t{value} << pending_bits;
        for (pending_bits += D; pending_bits >= 8; pending_bits -= 8, pending >>= 8U)
            packed[out++] = static_cast<std::uint8_t>(pending);
    }
    if (pending_bits > 0) packed[out] = static_cast<std::uint8_t>(pending);
}

template <int D>
void unpack(std::span<const std::uint8_t> packed, std::span<std::uint16_t> dn) noexcept {
    const std::size_t groups = whole_groups<D>(dn.size(), packed.size());
    for (std::size_t g = 0; g < groups; ++g) unpack_eight<D>(&packed[g * D], &dn[g * 8]);
    std::uint32_t pending = 0;
    int pending_bits = 0;
    std::size_t in = groups * D;
    for (std::uint16_t& value : dn.subspan(groups * 8)) {
        for (; pending_bits < D; pending_bits += 8)
            pending |= std::uint32_t{packed[in++]} << pending_bits;
        value = static_cast<std::uint16_t>(pending & kLane<D>);
        pending >>= static_cast<unsigned>(D);
        pending_bits -= D;
    }
}

template <int... I>
constexpr auto pack_table(std::integer_sequence<int, I...>) {
    return std::array{&pack<I + 1>...};
}

template <int... I>
constexpr auto unpack_table(std::integer_sequence<int, I...>) {
    return std::array{&unpack<I + 1>...};
}

constexpr auto kPack = pack_table(std::make_integer_sequence<int, 16>{});
constexpr auto kUnpack = unpack_table(std::make_integer_sequence<int, 16>{});

}  // namespace

void pack_bits(std::span<const std::uint16_t> dn, int bit_depth,
               std::span<std::uint8_t> packed) noexcept {
    assert(bit_depth >= 1 && bit_depth <= 16);
    assert(packed.size() == packed_bytes(dn.size(), bit_depth));
    kPack[static_cast<std::size_t>(bit_depth - 1)](dn, packed);
}

void unpack_bits(std::span<const std::uint8_t> packed, int bit_depth,
                 std::span<std::uint16_t> dn) noexcept {
    assert(bit_depth >= 1 && bit_depth <= 16);
    assert(packed.size() == packed_bytes(dn.size(), bit_depth));
    kUnpack[static_cast<std::size_t>(bit_depth - 1)](packed, dn);
}

}  // namespace stipple
