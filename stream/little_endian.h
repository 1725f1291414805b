#pragma once

#include <bit>
#include <cassert>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.h"

namespace stipple {

// The stream is little-endian; so are all machines that Stipple is built for.
static_assert(std::endian::native == std::endian::little);

template <typename T>
concept Stored = std::unsigned_integral<T> || std::same_as<T, float> || std::same_as<T, double>;

/// The number stored at `bytes`. Precondition: sizeof(T) bytes are readable.
template <Stored T>
[[nodiscard]] T load(const std::uint8_t* bytes) {
    T value;
    std::memcpy(&value, bytes, sizeof(T));
    return value;
}

/// Precondition: sizeof(T) bytes are writable.
template <Stored T>
void store(std::uint8_t* bytes, T value) {
    std::memcpy(bytes, &value, sizeof(T));
}

template <Stored T>
void append(std::vector<std::uint8_t>& bytes, T value) {
    bytes.resize(bytes.size() + sizeof(T));
    store(bytes.data() + bytes.size() - sizeof(T), value);
}

/// Reads numbers from a part of a file, one after the other.
class ByteCursor {
  public:
    /// `bytes` begin at `offset` of the file that messages call `where`.
    ByteCursor(std::span<const std::uint8_t> bytes, std::size_t offset, std::string_view where)
        : bytes_(bytes), offset_(offset), where_(where) {}

    [[nodiscard]] std::size_t left() const { return bytes_.size() - at_; }

    /// \throws InputError if the bytes end before the number.
    template <Stored T>
    [[nodiscard]] T take() {
        if (left() < sizeof(T)) fail("ends too early");
        at_ += sizeof(T);
        return load<T>(&bytes_[at_ - sizeof(T)]);
    }

    /// Unsigned LEB128. \throws InputError unless it is the shortest form of a 64-bit number.
    [[nodiscard]] std::uint64_t take_varint() {
        std::uint64_t value = 0;
        for (unsigned shift = 0; shift < 64; shift += 7) {
            const auto byte = take<std::uint8_t>();
            if (shift == 63 && byte > 1) break;
            value |= std::uint64_t{byte & 0x7FU} << shift;
            if (byte >= 0x80) continue;
            if (byte == 0 && shift > 0) fail("a varint is not in its shortest form");
            return value;
        }
        fail("a varint exceeds 64 bits");
    }

    /// \throws InputError naming file and offset of the number that was taken last.
    [[noreturn]] void fail(std::string_view problem) const {
        throw InputError(
            std::string(where_).append(": byte ").append(std::to_string(offset_ + at_)), problem);
    }

  private:
    std::span<const std::uint8_t> bytes_;
    std::size_t offset_;
    std::string_view where_;
    std::size_t at_ = 0;
};

inline void append_varint(std::vector<std::uint8_t>& bytes, std::uint64_t value) {
    for (; value >= 0x80; value >>= 7U) bytes.push_back(static_cast<std::uint8_t>(value | 0x80U));
    bytes.push_back(static_cast<std::uint8_t>(value));
}

}  // namespace stipple
