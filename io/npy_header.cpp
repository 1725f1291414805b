#include "io/npy_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <vector>

#include "core/error.h"
#include "core/light.h"
#include "core/text.h"

namespace stipple {
namespace {

constexpr std::string_view kMagic = "\x93NUMPY";

struct TypeName {
    std::string_view name;
    NpyType type;
};
constexpr TypeName kTypes[] = {{"|u1", NpyType::kUint8},  {"<u1", NpyType::kUint8},
                               {"<u2", NpyType::kUint16}, {"<f2", NpyType::kHalf},
                               {"<f4", NpyType::kFloat},  {"<f8", NpyType::kDouble}};

/// A type that can be read, with the same numbers as far as it has them. Light is positive.
std::string type_for(std::string_view name) {
    const std::string_view kind = name.substr(std::min<std::size_t>(1, name.size()));
    if (name.starts_with('>') && (kind == "u2" || kind.starts_with('f')))
        return fmt::format("<{}", kind);
    return kind == "b1" || kind == "i1" ? "u1" : kind == "i2" ? "u2" : "f4";
}

NpyType type_of(std::string_view name, std::string_view where) {
    for (const TypeName& known : kTypes)
        if (known.name == name) return known.type;
    throw InputError(where, fmt::format("values of type \"{}\" cannot be read; save as "
                                        "little-endian u1, u2, f2, f4 or f8, as "
                                        "video.astype(\"{}\")",
                                        name, type_for(name)));
}

void take_shape(std::vector<std::uint64_t> shape, std::string_view where, NpyHeader& header) {
    if (shape.size() == 2) shape.insert(shape.begin(), 1);
    if (shape.size() != 3 && !(shape.size() == 4 && shape[3] == 3)) {
        std::vector<std::string> sizes(shape.size());
        std::transform(shape.begin(), shape.end(), sizes.begin(),
                       [](std::uint64_t size) { return std::to_string(size); });
        throw InputError(
            where,
            fmt::format(
                "shape ({}) is not (T,H,W), (T,H,W,3) or (H,W){}", joined(sizes),
                shape.size() == 4 && shape[1] == 3 ? "; save video.transpose(0, 2, 3, 1)" : ""));
    }
    if (shape[0] == 0) throw InputError(where, "holds no frames");
    if (shape[0] > static_cast<std::uint64_t>(std::numeric_limits<int>::max()))
        throw InputError(where, fmt::format("{} frames are too many", shape[0]));
    header.slots = static_cast<int>(shape[0]);
    header.shape = checked_shape(shape[1], shape[2], shape.size() == 4 ? 3 : 1, where);
}

}  // namespace

NpyDictionary find_npy_dictionary(std::string_view start, std::string_view where) {
    if (!start.starts_with(kMagic)) throw InputError(where, "is not a .npy file");
    const auto byte = [&](std::size_t i) {
        if (i >= start.size()) throw InputError(where, "ends within its header");
        return static_cast<std::size_t>(static_cast<unsigned char>(start[i]));
    };
    const std::size_t version = byte(6);
    if (version < 1 || version > 3)
        throw InputError(where, fmt::format("offset 6: .npy version {} is unknown", version));
    const std::size_t length_bytes = version == 1 ? 2 : 4;
    std::size_t length = 0;
    for (std::size_t i = 0; i < length_bytes; ++i) length |= byte(8 + i) << (8 * i);
    const std::size_t begin = 8 + length_bytes;
    if (length > kMaxNpyHeaderBytes - begin)
        throw InputError(where, fmt::format("offset 8: a header of {} bytes is too long", length));
    if (length > start.size() - begin) throw InputError(where, "ends within its header");
    return {start.substr(begin, length), begin + length};
}

std::size_t npy_type_bytes(NpyType type) {
    switch (type) {
        case NpyType::kUint8:
            return 1;
        case NpyType::kUint16:
        case NpyType::kHalf:
            return 2;
        case NpyType::kFloat:
            return 4;
        case NpyType::kDouble:
            break;
    }
    return 8;
}

NpyHeader parse_npy_header(std::span<const std::byte> start, std::uint64_t file_bytes,
                           std::string_view where) {
    // Bytes may be read through char.
    const auto text =
        find_npy_dictionary({reinterpret_cast<const char*>(start.data()), start.size()}, where);
    NpyHeader header;
    header.data_offset = text.data_offset;
    const NpyFields fields = read_npy_fields(text.text, where);
    header.type = type_of(fields.descr, where);
    if (fields.fortran_order)
        throw InputError(where, "is in Fortran order; save numpy.ascontiguousarray(video)");
    take_shape(fields.shape, where, header);
    // At most 2^31 * 2^28 * 8 = 2^62: no overflow.
    const std::uint64_t data_bytes =
        static_cast<std::uint64_t>(header.slots) * std::uint64_t{header.frame_bytes()};
    if (file_bytes - header.data_offset != data_bytes)
        throw InputError(where,
                         fmt::format("{} frames need {} bytes, but the file holds {}; it is {}",
                                     header.slots, data_bytes, file_bytes - header.data_offset,
                                     file_bytes - header.data_offset < data_bytes
                                         ? "truncated or damaged"
                                         : "damaged, or several arrays were saved into it"));
    return header;
}

std::string format_npy_header(int slots, FrameShape shape, std::string_view comment) {
    constexpr std::size_t kHeaderBytes = 128;  // a multiple of 64; fits the largest numbers
    constexpr std::size_t kBegin = 10;
    const std::string_view colour = shape.planes == 3 ? ", 3" : "";
    std::string dictionary =
        fmt::format("{{'descr': '<f4', 'fortran_order': False, 'shape': ({}, {}, {}{}), }}", slots,
                    shape.rows, shape.cols, colour);
    if (!comment.empty()) dictionary += fmt::format(" # {}", comment);
    dictionary.resize(kHeaderBytes - kBegin - 1, ' ');
    std::string header(kMagic);
    header.append({1, 0, static_cast<char>(kHeaderBytes - kBegin), 0});
    return header + dictionary + '\n';
}

}  // namespace stipple
