#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <span>

#include "core/error.h"
#include "io/npy_file.h"

namespace stipple {
namespace {

/// A header that passes describes the file exactly.
void parse(std::span<const std::byte> start, std::uint64_t file_bytes) {
    try {
        const NpyHeader header = parse_npy_header(start, file_bytes, "fuzz.npy");
        const bool exact = header.slots > 0 && header.shape.sites() > 0 &&
                           header.data_offset <= start.size() &&
                           file_bytes - header.data_offset ==
                               static_cast<std::uint64_t>(header.slots) * header.frame_bytes();
        if (!exact) std::abort();
    } catch (const InputError&) {
    }
}

}  // namespace
}  // namespace stipple

/// Input: the length of the pretended file (8 bytes), then its start.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    std::uint64_t file_bytes = 0;
    if (size < sizeof(file_bytes)) return 0;
    std::memcpy(&file_bytes, data, sizeof(file_bytes));
    const auto start = std::as_bytes(std::span(data, size)).subspan(sizeof(file_bytes));
    stipple::parse(start, start.size());
    stipple::parse(start, std::max<std::uint64_t>(file_bytes, start.size()));
    return 0;
}
