#pragma once

#include <zlib.h>

#include <cstdint>
#include <string>
#include <vector>

namespace stipple {

inline std::vector<std::uint8_t> bytes_of(const std::string& text) {
    return {text.begin(), text.end()};
}

/// A zip file of one file "c.xml" (APPNOTE.TXT of PKWARE, 4.3), deflated or stored.
inline std::vector<std::uint8_t> zip_of(const std::vector<std::uint8_t>& content, bool deflated) {
    std::vector<std::uint8_t> packed = content;
    if (deflated) {
        packed.resize(compressBound(content.size()));
        z_stream stream{};
        deflateInit2(&stream, Z_BEST_COMPRESSION, Z_DEFLATED, -MAX_WBITS, 8, Z_DEFAULT_STRATEGY);
        stream.next_in = const_cast<std::uint8_t*>(content.data());
        stream.avail_in = static_cast<uInt>(content.size());
        stream.next_out = packed.data();
        stream.avail_out = static_cast<uInt>(packed.size());
        deflate(&stream, Z_FINISH);
        packed.resize(stream.total_out);
        deflateEnd(&stream);
    }
    std::vector<std::uint8_t> zip;
    const auto number = [&](std::size_t value, int bytes) {
        for (int i = 0; i < bytes; ++i) zip.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
    };
    const std::string name = "c.xml";
    const auto sizes = [&] {
        number(crc32(0, content.data(), static_cast<uInt>(content.size())), 4);
        number(packed.size(), 4);
        number(content.size(), 4);
        number(name.size(), 2);
        number(0, 2);  // extra field
    };
    const auto kind = [&] {
        number(20, 2);  // version 2.0 is needed
        number(0, 2);
        number(deflated ? 8 : 0, 2);
        number(0, 4);  // time
    };
    number(0x04034B50, 4);
    kind();
    sizes();
    zip.insert(zip.end(), name.begin(), name.end());
    zip.insert(zip.end(), packed.begin(), packed.end());
    const std::size_t directory = zip.size();
    number(0x02014B50, 4);
    number(20, 2);  // made by
    kind();
    sizes();
    zip.resize(directory + 46, 0);  // comment, disk, attributes, offset of the header
    zip.insert(zip.end(), name.begin(), name.end());
    const std::size_t end = zip.size();
    number(0x06054B50, 4);
    number(0, 4);
    number(1, 2);
    number(1, 2);
    number(end - directory, 4);
    number(directory, 4);
    number(0, 2);
    return zip;
}

}  // namespace stipple
