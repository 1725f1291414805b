#include "capture/frame_payload.h"

#define XXH_INLINE_ALL
#include <xxhash.h>

#include <algorithm>
#include <array>
#include <cstring>

namespace stipple {
namespace {

// From a random source, fixed: an image would have to hold just these bytes over and over.
constexpr std::array<std::uint8_t, 8> kPattern{0x5D, 0xE3, 0x1B, 0xC6, 0x72, 0x9F, 0x04, 0xA8};

bool is_unwritten(std::span<const std::uint8_t> buffer, std::size_t at) {
    return buffer[at] == kPattern[at % kPattern.size()];
}

bool is_unwritten_word(std::span<const std::uint8_t> buffer, std::size_t at) {
    return std::memcmp(&buffer[at], kPattern.data(), kPattern.size()) == 0;
}

}  // namespace

void mark_unwritten(std::span<std::uint8_t> buffer) noexcept {
    constexpr std::size_t kWord = kPattern.size();
    std::size_t at = 0;
    for (; at + kWord <= buffer.size(); at += kWord)
        std::memcpy(&buffer[at], kPattern.data(), kWord);
    mark_unwritten(buffer, at, buffer.size());
}

void mark_unwritten(std::span<std::uint8_t> buffer, std::size_t begin, std::size_t end) noexcept {
    for (std::size_t at = begin; at < end; ++at) buffer[at] = kPattern[at % kPattern.size()];
}

std::vector<std::pair<std::size_t, std::size_t>> clear_holes(std::span<std::uint8_t> buffer) {
    constexpr std::size_t kWord = kPattern.size();
    std::vector<std::pair<std::size_t, std::size_t>> holes;
    std::size_t done = 0;  // bytes before it belong to no later hole
    for (std::size_t at = 0; at + kWord <= buffer.size(); at += kWord) {
        if (at < done || !is_unwritten_word(buffer, at)) continue;
        std::size_t begin = at;
        while (begin > done && is_unwritten(buffer, begin - 1)) --begin;
        std::size_t end = at + kWord;
        while (end < buffer.size() && is_unwritten(buffer, end)) ++end;
        holes.emplace_back(begin, end);
        done = end;
    }
    std::size_t tail = buffer.size();
    while (tail > done && is_unwritten(buffer, tail - 1)) --tail;
    if (tail < buffer.size()) holes.emplace_back(tail, buffer.size());
    for (const auto& [begin, end] : holes)
        std::fill(buffer.begin() + static_cast<std::ptrdiff_t>(begin),
                  buffer.begin() + static_cast<std::ptrdiff_t>(end), std::uint8_t{0});
    return holes;
}

std::uint64_t payload_hash(std::span<const std::uint8_t> payload) {
    return XXH3_64bits(payload.data(), payload.size());
}

}  // namespace stipple
