#include <fmt/format.h>
#include <zlib.h>

#include <limits>
#include <string_view>

#include "core/error.h"
#include "io/little_numbers.h"
#include "io/named_arrays.h"

// ZIP: APPNOTE.TXT of PKWARE, 4.3; .npy: numpy.lib.format, version 1.0.
namespace stipple {
namespace {

constexpr std::uint16_t kVersion = 20;                      // of ZIP that a reader needs: 2.0
constexpr std::uint32_t kFirstDay = 1U << 21U | 1U << 16U;  // 1 January 1980, midnight
constexpr std::uint64_t kMaxBytes = std::numeric_limits<std::uint32_t>::max();

/// Header of a .npy file, of a multiple of 64 bytes.
std::string npy_header(const NamedArray& array) {
    constexpr std::string_view kDescr[] = {"<f8", "<f4", "|u1"};  // by index of the variant
    constexpr std::size_t kBegin = 10, kAlign = 64;
    std::string sides;
    for (const std::size_t side : array.shape) sides += fmt::format("{},", side);
    std::string text = fmt::format("{{'descr': '{}', 'fortran_order': False, 'shape': ({}), }}",
                                   kDescr[array.values.index()], sides);
    text.resize((kBegin + text.size() + kAlign) / kAlign * kAlign - kBegin - 1, ' ');
    text += '\n';
    std::string header("\x93NUMPY\x01\x00", 8);
    append_number(header, static_cast<std::uint16_t>(text.size()));
    return header + text;
}

/// An entry of the archive.
struct Entry {
    std::string name;
    std::uint32_t crc = 0, bytes = 0, offset = 0;
};

/// The fields that the header of an entry and the directory share.
void append_fields(std::string& text, const Entry& entry) {
    append_number(text, kVersion);
    append_number(text, std::uint32_t{0});  // no flags, stored
    append_number(text, kFirstDay);
    append_number(text, entry.crc);
    append_number(text, entry.bytes);
    append_number(text, entry.bytes);
    append_number(text, static_cast<std::uint16_t>(entry.name.size()));
    append_number(text, std::uint16_t{0});  // no extra field
}

std::string directory_of(std::span<const Entry> entries, std::uint64_t offset) {
    std::string text;
    for (const Entry& entry : entries) {
        text += "PK\x01\x02";
        append_number(text, kVersion);
        append_fields(text, entry);
        text.append(10, '\0');  // no comment, disk 0, no attributes
        append_number(text, entry.offset);
        text += entry.name;
    }
    const auto bytes = static_cast<std::uint32_t>(text.size());
    const auto count = static_cast<std::uint16_t>(entries.size());
    text += std::string("PK\x05\x06\0\0\0\0", 8);
    append_number(text, count);
    append_number(text, count);
    append_number(text, bytes);
    append_number(text, static_cast<std::uint32_t>(offset));
    return text.append(2, '\0');
}

}  // namespace

void write_npz(OutputFile& file, std::span<const NamedArray> arrays, const std::string& where) {
    constexpr std::uint64_t kMoreBytes = 1024;  // of an array, in headers
    std::uint64_t all = 0;
    for (const NamedArray& array : arrays) all += bytes_of(array).size() + kMoreBytes;
    if (all > kMaxBytes)
        throw InputError(where, "would be longer than the 4 GiB of a .npz; export fewer slots");
    std::vector<Entry> entries;
    std::uint64_t offset = 0;
    const auto write = [&](std::span<const std::byte> bytes) {
        file.write(bytes);
        offset += bytes.size();
    };
    for (const NamedArray& array : arrays) {
        const std::string header = npy_header(array);
        const auto values = bytes_of(array);
        const auto crc_after = [](uLong crc, std::span<const std::byte> bytes) {
            return crc32_z(crc, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size());
        };
        const uLong crc = crc_after(crc_after(0, std::as_bytes(std::span(header))), values);
        entries.push_back({.name = array.name + ".npy",
                           .crc = static_cast<std::uint32_t>(crc),
                           .bytes = static_cast<std::uint32_t>(header.size() + values.size()),
                           .offset = static_cast<std::uint32_t>(offset)});
        std::string local = "PK\x03\x04";
        append_fields(local, entries.back());
        local += entries.back().name + header;
        write(std::as_bytes(std::span(local)));
        write(values);
    }
    const std::string directory = directory_of(entries, offset);
    write(std::as_bytes(std::span(directory)));
}

}  // namespace stipple
