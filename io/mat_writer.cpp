#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <string_view>

#include "core/error.h"
#include "io/little_numbers.h"
#include "io/named_arrays.h"

// MATLAB "MAT-File Format", level 5: elements of a type, a length and data padded to 8 bytes.
namespace stipple {
namespace {

constexpr std::uint32_t kInt8 = 1, kInt32 = 5, kUint32 = 6, kMatrix = 14;
struct Kind {
    std::uint32_t element, matrix_class;
};
constexpr Kind kKinds[] = {{9, 6}, {7, 7}, {2, 9}};  // double, single, uint8: as the variant

constexpr std::size_t padded(std::size_t bytes) {
    return (bytes + 7) / 8 * 8;
}

void append_tag(std::string& text, std::uint32_t type, std::size_t bytes) {
    append_number(text, type);
    append_number(text, static_cast<std::uint32_t>(bytes));
}

void append_element(std::string& text, std::uint32_t type, std::string_view content) {
    append_tag(text, type, content.size());
    text.append(content).append(padded(content.size()) - content.size(), '\0');
}

/// Sides in the order of MATLAB, two or more.
std::vector<std::size_t> mat_sides(const NamedArray& array) {
    std::vector<std::size_t> sides(array.shape);
    while (sides.size() < 2) sides.insert(sides.begin(), 1);
    std::rotate(sides.begin(), sides.end() - 2, sides.end());
    std::reverse(sides.begin() + 2, sides.end());
    return sides;
}

/// All of a variable but its values.
std::string matrix_header(const NamedArray& array, std::size_t value_bytes) {
    const Kind kind = kKinds[array.values.index()];
    std::string flags, sides;
    append_number(flags, std::uint64_t{kind.matrix_class});
    for (const std::size_t side : mat_sides(array))
        append_number(sides, static_cast<std::uint32_t>(side));
    std::string content;
    append_element(content, kUint32, flags);
    append_element(content, kInt32, sides);
    append_element(content, kInt8, array.name);
    append_tag(content, kind.element, value_bytes);
    std::string text;
    append_tag(text, kMatrix, content.size() + padded(value_bytes));
    return text + content;
}

/// A frame of rows x columns, column by column.
template <typename Value>
void transpose(std::span<const Value> frame, std::size_t rows, std::span<Value> turned) {
    const std::size_t cols = frame.size() / rows;
    for (std::size_t row = 0; row < rows; ++row)
        for (std::size_t col = 0; col < cols; ++col)
            turned[col * rows + row] = frame[row * cols + col];
}

}  // namespace

void write_mat(OutputFile& file, std::span<const NamedArray> arrays, const std::string& where) {
    constexpr std::size_t kTextBytes = 116, kMaxBytes = std::numeric_limits<std::int32_t>::max();
    std::string head = "MATLAB 5.0 MAT-file";
    head.resize(kTextBytes, ' ');
    head.append(8, '\0');
    append_number(head, std::uint16_t{0x0100});
    head += "IM";
    file.write(std::as_bytes(std::span(head)));
    for (const NamedArray& array : arrays) {
        const std::size_t bytes = bytes_of(array).size();
        if (bytes > kMaxBytes - 1024)
            throw InputError(where, fmt::format("\"{}\" would be longer than the 2 GiB of a "
                                                "variable; export fewer slots, or to a .npz",
                                                array.name));
        const std::string header = matrix_header(array, bytes);
        file.write(std::as_bytes(std::span(header)));
        std::visit(
            [&]<typename Value>(const std::vector<Value>& values) {
                const auto sides = mat_sides(array);
                std::vector<Value> turned(sides[0] * sides[1]);
                for (std::size_t at = 0; at < values.size(); at += turned.size()) {
                    transpose(std::span(values).subspan(at, turned.size()), sides[0],
                              std::span(turned));
                    file.write(std::as_bytes(std::span(turned)));
                }
            },
            array.values);
        const std::string padding(padded(bytes) - bytes, '\0');
        file.write(std::as_bytes(std::span(padding)));
    }
}

}  // namespace stipple
