#include "capture/aravis/genicam_description.h"

#include <zlib.h>

#include <algorithm>
#include <array>

namespace stipple {
namespace {

using Bytes = std::vector<std::uint8_t>;

struct Damaged {};

class ZipFile {
  public:
    ZipFile(std::span<const std::uint8_t> bytes, std::size_t max) : bytes_(bytes), max_(max) {}

    /// \throws Damaged.
    [[nodiscard]] Bytes last_file() const {
        constexpr std::array<std::uint8_t, 4> kEnd{0x50, 0x4B, 0x05, 0x06};
        const auto found = std::find_end(bytes_.begin(), bytes_.end(), kEnd.begin(), kEnd.end());
        const auto end = static_cast<std::size_t>(found - bytes_.begin());
        const std::size_t files = number(end + 10, 2);
        const std::size_t directory = end - number(end + 12, 4);
        const std::size_t begin = directory - number(end + 16, 4);
        Bytes content;
        std::size_t at = directory;
        for (std::size_t i = 0; i < files; ++i) {
            if (number(at, 4) != 0x02014B50) throw Damaged{};
            content = file(begin + number(at + 42, 4), number(at + 20, 4), number(at + 24, 4));
            const std::size_t name = number(at + 28, 2);
            at += 46 + name + number(at + 30, 2) + number(at + 32, 2);
            check(at, 0);
        }
        return content;
    }

  private:
    void check(std::size_t at, std::size_t bytes) const {
        if (at > bytes_.size() || bytes_.size() - at < bytes) throw Damaged{};
    }

    [[nodiscard]] std::size_t number(std::size_t at, std::size_t bytes) const {
        check(at, bytes);
        std::size_t value = 0;
        for (std::size_t i = 0; i < bytes; ++i) value |= std::size_t{bytes_[at + i]} << (8 * i);
        return value;
    }

    /// Of `packed` bytes behind the header at `header`; stored as it is if these are not fewer.
    [[nodiscard]] Bytes file(std::size_t header, std::size_t packed, std::size_t size) const {
        if (size > max_) throw Damaged{};
        const std::size_t name = number(header + 26, 2);
        const std::size_t at = header + 30 + name + number(header + 28, 2);
        check(at, std::min(packed, size));
        Bytes content(size);
        if (packed >= size) {
            std::copy_n(bytes_.begin() + static_cast<std::ptrdiff_t>(at), size, content.begin());
            return content;
        }
        z_stream inflating{};
        inflating.next_in = const_cast<std::uint8_t*>(bytes_.data() + at);
        inflating.avail_in = static_cast<uInt>(packed);
        inflating.next_out = content.data();
        inflating.avail_out = static_cast<uInt>(size);
        inflateInit2(&inflating, -MAX_WBITS);
        inflate(&inflating, Z_FINISH);
        inflateEnd(&inflating);
        return content;
    }

    std::span<const std::uint8_t> bytes_;
    std::size_t max_;
};

}  // namespace

std::optional<std::vector<std::uint8_t>> unzipped_description(std::span<const std::uint8_t> zip,
                                                              std::size_t max_bytes) {
    try {
        return ZipFile(zip, max_bytes).last_file();
    } catch (const Damaged&) {
        return {};
    }
}

}  // namespace stipple
