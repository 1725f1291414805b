#include "core/tiff_pages.h"

#include <cstddef>

#include "core/error.h"

namespace stipple {
namespace {

constexpr std::size_t kEntryBytes = 12;

/// `count` bytes at `offset` as an integer; 0 beyond the end.
std::uint32_t number(std::span<const std::uint8_t> bytes, std::size_t offset, std::size_t count) {
    if (bytes.size() < count || offset > bytes.size() - count) return 0;
    const bool little_endian = bytes[0] == 'I';
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < count; ++i)
        value = value << 8U | bytes[offset + (little_endian ? count - 1 - i : i)];
    return value;
}

}  // namespace

void check_single_tiff_page(std::span<const std::uint8_t> bytes, std::string_view place) {
    constexpr std::uint32_t kClassicTiff = 42;
    if (bytes.size() < 8 || number(bytes, 2, 2) != kClassicTiff) return;
    const std::size_t directory = number(bytes, 4, 4);
    const std::size_t entries = number(bytes, directory, 2);
    const std::uint32_t next = number(bytes, directory + 2 + entries * kEntryBytes, 4);
    if (next != 0) throw InputError(place, "holds more than one picture; save one picture a file");
}

}  // namespace stipple
