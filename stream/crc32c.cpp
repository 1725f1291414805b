#include "stream/crc32c.h"

#include <array>

#include "stream/little_endian.h"

#if defined(__x86_64__)
#include <nmmintrin.h>
#endif

namespace stipple {
namespace {

using Table = std::array<std::uint32_t, 256>;

// tables[k][b] is the CRC of byte b followed by k zero bytes ("slicing by 8": Kounavis and Berry,
// ISCC 2005), so that eight bytes are one round of independent look-ups.
constexpr std::array<Table, 8> make_tables() {
    std::array<Table, 8> tables{};
    for (std::uint32_t byte = 0; byte < 256; ++byte) {
        std::uint32_t crc = byte;
        for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1U) ^ ((crc & 1U) != 0 ? 0x82F63B78U : 0U);
        tables[0][byte] = crc;
    }
    for (std::size_t k = 1; k < 8; ++k)
        for (std::size_t byte = 0; byte < 256; ++byte) {
            const std::uint32_t crc = tables[k - 1][byte];
            tables[k][byte] = (crc >> 8U) ^ tables[0][crc & 0xFFU];
        }
    return tables;
}

constexpr std::array<Table, 8> kTables = make_tables();

std::uint32_t add_byte(std::uint32_t crc, std::uint8_t byte) {
    return (crc >> 8U) ^ kTables[0][(crc ^ byte) & 0xFFU];
}

std::uint32_t add_eight(std::uint32_t crc, std::uint64_t bytes) {
    bytes ^= crc;
    std::uint32_t sum = 0;
    for (std::size_t i = 0; i < 8; ++i) sum ^= kTables[7 - i][(bytes >> (8 * i)) & 0xFFU];
    return sum;
}

#if defined(__x86_64__)
__attribute__((target("sse4.2"))) std::uint32_t crc32c_sse42(std::span<const std::uint8_t> bytes,
                                                             std::uint32_t previous) {
    std::uint64_t crc = ~previous;
    while (bytes.size() >= 8) {
        crc = _mm_crc32_u64(crc, load<std::uint64_t>(bytes.data()));
        bytes = bytes.subspan(8);
    }
    auto last = static_cast<std::uint32_t>(crc);
    for (const std::uint8_t byte : bytes) last = _mm_crc32_u8(last, byte);
    return ~last;
}
#endif

}  // namespace

std::uint32_t crc32c_portable(std::span<const std::uint8_t> bytes, std::uint32_t previous) {
    std::uint32_t crc = ~previous;
    while (bytes.size() >= 8) {
        crc = add_eight(crc, load<std::uint64_t>(bytes.data()));
        bytes = bytes.subspan(8);
    }
    for (const std::uint8_t byte : bytes) crc = add_byte(crc, byte);
    return ~crc;
}

std::uint32_t crc32c(std::span<const std::uint8_t> bytes, std::uint32_t previous) {
#if defined(__x86_64__)
    static const bool has_instruction = __builtin_cpu_supports("sse4.2") != 0;
    if (has_instruction) return crc32c_sse42(bytes, previous);
#endif
    return crc32c_portable(bytes, previous);
}

}  // namespace stipple
