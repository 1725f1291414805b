#include "io/npy_file.h"

#include <fmt/format.h>
#include <half.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <string>

#include "core/error.h"
#include "core/geometry.h"
#include "core/index.h"
#include "core/input_file.h"
#include "core/memory_limit.h"

namespace stipple {
namespace {

constexpr std::uint64_t kMaxValues = std::uint64_t{1} << 26U;

/// How the values of a type become numbers.
struct ValueType {
    std::string_view name;
    std::size_t bytes;
    void (*convert)(std::span<const std::byte>, std::vector<double>&);
};

template <typename Value>
void convert(std::span<const std::byte> bytes, std::vector<double>& values) {
    for (std::size_t i = 0; i < values.size(); ++i) {
        Value value;
        std::memcpy(&value, &bytes[i * sizeof(Value)], sizeof(Value));
        if constexpr (std::is_same_v<Value, half>)
            values[i] = static_cast<double>(static_cast<float>(value));
        else
            values[i] = static_cast<double>(value);
    }
}

constexpr ValueType kTypes[] = {
    {"|b1", 1, convert<std::uint8_t>}, {"|u1", 1, convert<std::uint8_t>},
    {"|i1", 1, convert<std::int8_t>},  {"<u2", 2, convert<std::uint16_t>},
    {"<i2", 2, convert<std::int16_t>}, {"<u4", 4, convert<std::uint32_t>},
    {"<i4", 4, convert<std::int32_t>}, {"<u8", 8, convert<std::uint64_t>},
    {"<i8", 8, convert<std::int64_t>}, {"<f2", 2, convert<half>},
    {"<f4", 4, convert<float>},        {"<f8", 8, convert<double>}};

const ValueType& type_of(std::string_view name, std::string_view where) {
    const auto found = std::ranges::find(kTypes, name, &ValueType::name);
    if (found == std::end(kTypes))
        throw InputError(where, fmt::format("values of type \"{}\" cannot be read; save as bool, "
                                            "integers or little-endian floats",
                                            name));
    return *found;
}

void check_shape(const std::vector<std::uint64_t>& shape, std::string_view where) {
    if (shape.size() != 3)
        throw InputError(
            where,
            fmt::format("has {} dimensions; needs three: (slots, rows, columns)", shape.size()));
    std::uint64_t values = 1;
    for (const std::uint64_t side : shape) {
        if (side < 1 || side > kMaxFrameSide)
            throw InputError(where, fmt::format("shape ({}, {}, {}): sides are 1 to {}", shape[0],
                                                shape[1], shape[2], kMaxFrameSide));
        values *= side;
    }
    if (values > kMaxValues)
        throw InputError(where, fmt::format("shape ({}, {}, {}) has more than 2^26 values",
                                            shape[0], shape[1], shape[2]));
}

/// From the first index fastest to the last.
void reorder(NpyVolume& volume) {
    const auto layers = index(volume.layers), rows = index(volume.rows), cols = index(volume.cols);
    const std::vector<double> stored = volume.values;
    auto* value = volume.values.data();
    for (std::size_t layer = 0; layer < layers; ++layer)
        for (std::size_t row = 0; row < rows; ++row)
            for (std::size_t col = 0; col < cols; ++col)
                *value++ = stored[layer + layers * (row + rows * col)];
}

}  // namespace

NpyVolume parse_npy_volume(std::span<const std::byte> bytes, std::string_view where,
                           NpyImages images) {
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    const NpyDictionary dictionary = find_npy_dictionary(text.substr(0, kMaxNpyHeaderBytes), where);
    NpyFields fields = read_npy_fields(dictionary.text, where);
    const ValueType& type = type_of(fields.descr, where);
    if (images == NpyImages::kOneLayer && fields.shape.size() == 2)
        fields.shape.insert(fields.shape.begin(), 1);
    check_shape(fields.shape, where);
    check_memory(bytes.size() + (fields.fortran_order ? 2 : 1) * sizeof(double) * fields.shape[0] *
                                    fields.shape[1] * fields.shape[2],
                 where, "the volume");
    NpyVolume volume{.layers = static_cast<int>(fields.shape[0]),
                     .rows = static_cast<int>(fields.shape[1]),
                     .cols = static_cast<int>(fields.shape[2]),
                     .values = {}};
    const std::size_t count = fields.shape[0] * fields.shape[1] * fields.shape[2];
    const auto data = bytes.subspan(dictionary.data_offset);
    if (data.size() != count * type.bytes)
        throw InputError(where, fmt::format("{} values need {} bytes, but the file holds {}; it is "
                                            "truncated or damaged",
                                            count, count * type.bytes, data.size()));
    volume.values.resize(count);
    type.convert(data, volume.values);
    if (fields.fortran_order) reorder(volume);
    return volume;
}

NpyVolume read_npy_volume(const std::filesystem::path& file, NpyImages images) {
    std::error_code error;
    const std::uintmax_t size = std::filesystem::file_size(file, error);
    if (!error && size > kMaxValues * 8 + kMaxNpyHeaderBytes)
        throw InputError(file.string(), "is too long for a volume of at most 2^26 values");
    const std::vector<std::uint8_t> bytes = read_file(file);
    return parse_npy_volume(std::as_bytes(std::span(bytes)), file.string(), images);
}

}  // namespace stipple
