#include "decoder/learned/safetensors.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/index.h"
#include "stream/little_endian.h"

namespace stipple {
namespace {

constexpr std::size_t kLengthBytes = 8;
constexpr std::uint64_t kMaxHeaderBytes = 1'000'000;
constexpr const char* kMetadata = "__metadata__";

/// The number whose IEEE 754 binary16 has these bits; the conversion is exact.
float from_half(std::uint16_t bits) {
    const int exponent = (bits >> 10U) & 0x1F;
    const int fraction = bits & 0x3FF;
    constexpr int kImplicit = 0x400;
    float magnitude = 0;
    if (exponent == 0)
        magnitude = std::ldexp(static_cast<float>(fraction), -24);
    else if (exponent == 0x1F)
        magnitude = fraction == 0 ? HUGE_VALF : NAN;
    else
        magnitude = std::ldexp(static_cast<float>(kImplicit + fraction), exponent - 25);
    return (bits & 0x8000U) != 0 ? -magnitude : magnitude;
}

/// A tensor of the header.
struct Entry {
    std::vector<std::int64_t> shape;
    std::size_t value_bytes = 0;
    std::uint64_t begin = 0;  ///< in bytes after the header
    std::uint64_t end = 0;
};

/// \throws InputError at `where` unless it is an integer of at least 0.
std::uint64_t size_of(const nlohmann::json& json, const std::string& where) {
    if (!json.is_number_unsigned())
        throw InputError(where, "has a shape or data_offsets that are no integers of at least 0");
    return json.get<std::uint64_t>();
}

/// \throws nlohmann::json::exception, InputError.
Entry entry_of(const nlohmann::json& json, const std::string& where) {
    const std::string type = json.at("dtype");
    if (type != "F16" && type != "F32")
        throw InputError(where, "has another type than F16 and F32; convert it");
    const nlohmann::json& offsets = json.at("data_offsets");
    Entry entry{.shape = {},
                .value_bytes = type == "F16" ? sizeof(std::uint16_t) : sizeof(float),
                .begin = size_of(offsets.at(0), where),
                .end = size_of(offsets.at(1), where)};
    // Compared by division, as a product may exceed 64 bits.
    std::uint64_t left = entry.begin < entry.end ? entry.end - entry.begin : 0;
    bool filled = left % entry.value_bytes == 0;
    left /= entry.value_bytes;
    for (const nlohmann::json& json_size : json.at("shape")) {
        const std::uint64_t size = size_of(json_size, where);
        filled = filled && size > 0 && left % size == 0;
        if (filled) left /= size;
        entry.shape.push_back(static_cast<std::int64_t>(size));
    }
    if (!filled || left != 1)
        throw InputError(where, fmt::format("has the shape {} of {}, but data_offsets {}..{}",
                                            shape_text(entry.shape), type, entry.begin, entry.end));
    return entry;
}

Tensor tensor_of(const Entry& entry, std::span<const std::uint8_t> data, const std::string& where) {
    Tensor tensor{.shape = entry.shape, .values = {}};
    const auto bytes = data.subspan(entry.begin, entry.end - entry.begin);
    tensor.values.resize(bytes.size() / entry.value_bytes);
    for (std::size_t i = 0; i < tensor.values.size(); ++i) {
        const std::uint8_t* stored = &bytes[i * entry.value_bytes];
        const float value = entry.value_bytes == sizeof(float)
                                ? load<float>(stored)
                                : from_half(load<std::uint16_t>(stored));
        if (!std::isfinite(value))
            throw InputError(where,
                             fmt::format("holds {} at {}, which is not a finite number", value, i));
        tensor.values[i] = value;
    }
    return tensor;
}

/// The JSON at the start of the file. \throws InputError.
std::string_view header_of(std::span<const std::uint8_t> bytes, std::string_view where) {
    if (bytes.size() < kLengthBytes)
        throw InputError(where, "is no safetensors file: it has less than 8 bytes");
    const auto length = load<std::uint64_t>(bytes.data());
    if (length > kMaxHeaderBytes)
        throw InputError(where, fmt::format("is no safetensors file of a network: its header has "
                                            "{} bytes, of which at most {} are read",
                                            length, kMaxHeaderBytes));
    if (length > bytes.size() - kLengthBytes)
        throw InputError(where, fmt::format("ends within its header: it has {} bytes, the header "
                                            "alone {}; copy the file again",
                                            bytes.size(), length));
    return {reinterpret_cast<const char*>(bytes.data()) + kLengthBytes,
            static_cast<std::size_t>(length)};
}

/// \throws InputError unless the tensors fill `bytes` one after the other.
void check_extent(const std::map<std::string, Entry>& entries, std::uint64_t bytes,
                  std::string_view where) {
    std::vector<const Entry*> sorted;
    sorted.reserve(entries.size());
    for (const auto& [name, entry] : entries) sorted.push_back(&entry);
    std::ranges::sort(sorted, {}, &Entry::begin);
    std::uint64_t filled = 0;
    for (const Entry* entry : sorted) {
        if (entry->begin != filled)
            throw InputError(where, fmt::format("has a gap or an overlap of tensors at byte {} of "
                                                "its data; write the file again",
                                                filled));
        filled = entry->end;
    }
    if (filled != bytes)
        throw InputError(where, fmt::format("has {} bytes of data, but its tensors have {}; copy "
                                            "the file again",
                                            bytes, filled));
}

}  // namespace

std::string shape_text(std::span<const std::int64_t> shape) {
    std::string text;
    for (const std::int64_t size : shape)
        text.append(text.empty() ? "" : " x ").append(std::to_string(size));
    return text;
}

TensorFile parse_safetensors(std::span<const std::uint8_t> bytes, std::string_view where) {
    const std::string_view header = header_of(bytes, where);
    const auto data = bytes.subspan(kLengthBytes + header.size());
    const auto of = [&](const std::string& name) {
        return fmt::format("{}: tensor \"{}\"", where, name);
    };
    TensorFile file;
    std::map<std::string, Entry> entries;
    try {
        const auto json = nlohmann::json::parse(header);
        for (const auto& [name, value] : json.get_ref<const nlohmann::json::object_t&>())
            if (name == kMetadata)
                file.metadata = value.get<std::map<std::string, std::string>>();
            else
                entries[name] = entry_of(value, of(name));
    } catch (const nlohmann::json::exception&) {
        throw InputError(where,
                         "is no safetensors file: its header is not JSON with the dtype, "
                         "shape and data_offsets of each tensor");
    }
    check_extent(entries, data.size(), where);
    for (const auto& [name, entry] : entries) file.tensors[name] = tensor_of(entry, data, of(name));
    return file;
}

}  // namespace stipple
