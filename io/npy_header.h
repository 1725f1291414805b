#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/geometry.h"

namespace stipple {

/// The three entries of a .npy header, e.g. {'descr': '<f4', 'fortran_order': False,
/// 'shape': (2, 3, 4), }.
struct NpyFields {
    std::string descr;
    bool fortran_order = false;
    std::vector<std::uint64_t> shape;
};

/// Reads the Python dictionary of a .npy header, entries in any order.
/// \throws InputError at `where` if it is malformed or an entry is missing or unknown.
[[nodiscard]] NpyFields read_npy_fields(std::string_view dictionary, std::string_view where);

enum class NpyType { kUint8, kUint16, kHalf, kFloat, kDouble };

/// Bytes of one value.
[[nodiscard]] std::size_t npy_type_bytes(NpyType type);

/// Content of the header of a .npy video: an array (T,H,W), (T,H,W,3) or, of one frame,
/// (H,W) in C order.
struct NpyHeader {
    NpyType type = NpyType::kFloat;
    int slots = 0;
    FrameShape shape;
    std::size_t data_offset = 0;

    [[nodiscard]] std::size_t frame_bytes() const { return shape.sites() * npy_type_bytes(type); }
};

/// Maximum length of a header, from the start of the file.
inline constexpr std::size_t kMaxNpyHeaderBytes = 65536;

/// The Python dictionary of a header, and the position of the data.
struct NpyDictionary {
    std::string_view text;
    std::size_t data_offset = 0;
};

/// Finds the dictionary in `start`, the first bytes of a file. \throws InputError at `where` if the
/// file is no .npy file, has an unknown version, or ends within its header.
[[nodiscard]] NpyDictionary find_npy_dictionary(std::string_view start, std::string_view where);

/// Reads the header from `start`, the first min(file_bytes, kMaxNpyHeaderBytes) bytes of a file.
/// \throws InputError at `where` if the file is no .npy file, is not little-endian u1, u2, f2, f4
/// or f8 in C order, has another shape, is empty, or does not match the length of the file. Source:
/// numpy.lib.format, versions 1.0 to 3.0.
[[nodiscard]] NpyHeader parse_npy_header(std::span<const std::byte> start, std::uint64_t file_bytes,
                                         std::string_view where);

/// A header of fixed length for float32 frames of `shape`, so that the number of slots can be
/// written later. `comment`, of at most 32 letters, follows the dictionary after a #.
[[nodiscard]] std::string format_npy_header(int slots, FrameShape shape,
                                            std::string_view comment = {});

}  // namespace stipple
