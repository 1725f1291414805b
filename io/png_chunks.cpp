#include "io/png_chunks.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "core/error.h"
#include "core/light.h"
#include "core/memory_limit.h"

namespace stipple {
namespace {

constexpr std::array<std::uint8_t, 8> kSignature = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'};
constexpr std::size_t kChunkFrame = 12;  // length, type and CRC, 4 bytes each
constexpr std::size_t kHeaderBytes = 13;
constexpr std::uint32_t kMaxLength = 0x7FFFFFFF;
constexpr std::uint32_t kLinearGamma = 100000;  // 1.0 in a gAMA chunk

/// Table of the CRC-32 of ISO 3309 (reflected polynomial 0xEDB88320), byte by byte.
constexpr std::array<std::uint32_t, 256> crc_table() {
    std::array<std::uint32_t, 256> table{};
    for (std::uint32_t i = 0; i < 256; ++i) {
        std::uint32_t c = i;
        for (int bit = 0; bit < 8; ++bit) c = (c & 1U) != 0 ? 0xEDB88320U ^ (c >> 1U) : c >> 1U;
        table[i] = c;
    }
    return table;
}

std::uint32_t crc32(std::span<const std::uint8_t> bytes) {
    static constexpr auto kTable = crc_table();
    std::uint32_t crc = 0xFFFFFFFFU;
    for (const std::uint8_t byte : bytes) crc = kTable[(crc ^ byte) & 0xFFU] ^ (crc >> 8U);
    return ~crc;
}

std::uint32_t big_endian(std::span<const std::uint8_t> bytes) {
    return std::uint32_t{bytes[0]} << 24U | std::uint32_t{bytes[1]} << 16U |
           std::uint32_t{bytes[2]} << 8U | bytes[3];
}

bool is_type(std::span<const std::uint8_t> chunk, std::string_view type) {
    return std::equal(type.begin(), type.end(), chunk.begin() + 4);
}

/// Looks at the size that the data of an IHDR chunk announce. \throws InputError.
void check_size(std::span<const std::uint8_t> header, std::uint64_t file_bytes,
                std::string_view place) {
    const std::uint8_t colour_type = header[9];
    const bool grey = colour_type == 0 || colour_type == 4;
    const FrameShape shape =
        checked_shape(big_endian(header.subspan(4)), big_endian(header), grey ? 1 : 3, place);
    const std::uint64_t samples = colour_type == 3 ? shape.pixels() : shape.sites();
    check_packed(samples * header[8] / 8, file_bytes, place);
    const std::uint64_t unpacked = header[8] == 16 ? 2 : 1;
    check_memory((unpacked + sizeof(float)) * shape.sites(), place, "the picture", file_bytes);
}

/// The chunk that begins at `offset`, CRC included.
std::span<const std::uint8_t> chunk_at(std::span<const std::uint8_t> bytes, std::size_t offset,
                                       std::string_view place) {
    const auto fail = [&](std::string_view problem) {
        throw InputError(place, fmt::format("offset {}: {}", offset, problem));
    };
    const auto rest = bytes.subspan(offset);
    if (rest.size() < kChunkFrame) fail("the file ends too early");
    const std::uint32_t length = big_endian(rest);
    if (length > kMaxLength || length > rest.size() - kChunkFrame)
        fail("a chunk is longer than the file; the file is damaged or ends too early");
    const auto chunk = rest.first(length + kChunkFrame);
    if (crc32(chunk.subspan(4, length + 4)) != big_endian(chunk.last(4)))
        fail("a chunk has a wrong CRC; the file is damaged");
    return chunk;
}

}  // namespace

PngChunks critical_png_chunks(std::span<const std::uint8_t> bytes, std::string_view place) {
    if (bytes.size() < kSignature.size() ||
        !std::equal(kSignature.begin(), kSignature.end(), bytes.begin()))
        throw InputError(place, "is not a PNG file");
    PngChunks result;
    result.file.assign(kSignature.begin(), kSignature.end());
    for (std::size_t offset = kSignature.size();;) {
        const auto chunk = chunk_at(bytes, offset, place);
        if (offset == kSignature.size()) {
            if (!is_type(chunk, "IHDR") || chunk.size() != kHeaderBytes + kChunkFrame)
                throw InputError(place, "offset 8: the PNG header is missing");
            check_size(chunk.subspan(8), bytes.size(), place);
            const std::uint8_t colour_type = chunk[8 + 9];
            result.grey = colour_type == 0 || colour_type == 4;
            result.has_alpha = colour_type == 4 || colour_type == 6;
            result.gamma_coded = !result.grey && chunk[8 + 8] <= 8;
        }
        if (is_type(chunk, "tRNS")) result.has_alpha = true;
        if (is_type(chunk, "sRGB")) result.gamma_coded = true;
        if (is_type(chunk, "gAMA") && chunk.size() == kChunkFrame + 4)
            result.gamma_coded = big_endian(chunk.subspan(8)) != kLinearGamma;
        const bool critical = (chunk[4] & 0x20U) == 0;
        if (critical) result.file.insert(result.file.end(), chunk.begin(), chunk.end());
        if (is_type(chunk, "IEND")) return result;
        offset += chunk.size();
    }
}

}  // namespace stipple
