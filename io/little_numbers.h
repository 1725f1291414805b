#pragma once

#include <bit>
#include <concepts>
#include <cstddef>
#include <cstring>
#include <span>
#include <string>

#include "io/named_arrays.h"

namespace stipple {

static_assert(std::endian::native == std::endian::little, "values are written as they lie");

/// Appends the bytes of a number, the lowest first.
template <std::unsigned_integral Number>
void append_number(std::string& text, Number number) {
    const std::size_t at = text.size();
    text.resize(at + sizeof(Number));
    std::memcpy(&text[at], &number, sizeof(Number));
}

/// The values of an array as they lie.
[[nodiscard]] inline std::span<const std::byte> bytes_of(const NamedArray& array) {
    return std::visit([](const auto& values) { return std::as_bytes(std::span(values)); },
                      array.values);
}

}  // namespace stipple
