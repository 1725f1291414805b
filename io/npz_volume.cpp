#include "io/npz_volume.h"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <cctype>
#include <cstring>
#include <vector>

#include "core/error.h"
#include "core/input_file.h"
#include "core/memory_limit.h"

// ZIP: APPNOTE.TXT of PKWARE, 4.3. Sizes are those of the directory: numpy leaves them out
// elsewhere.
namespace stipple {
namespace {

constexpr std::size_t kEndBytes = 22, kEntryBytes = 46, kLocalBytes = 30;
constexpr std::uint32_t kEnd = 0x06054B50, kEntry = 0x02014B50, kLocal = 0x04034B50;
constexpr std::size_t kMaxListed = 8;

/// A whole archive; all that is taken of it is checked against its length.
class Archive {
  public:
    Archive(std::span<const std::uint8_t> bytes, const std::string& where)
        : bytes_(bytes), where_(where) {}

    template <typename Number>
    [[nodiscard]] Number number(std::size_t offset) const {
        Number value;
        std::memcpy(&value, part(offset, sizeof(Number)).data(), sizeof(Number));
        return value;
    }

    [[nodiscard]] std::span<const std::uint8_t> part(std::size_t offset, std::size_t length) const {
        if (offset > bytes_.size() || length > bytes_.size() - offset) damaged();
        return bytes_.subspan(offset, length);
    }

    [[nodiscard]] std::string_view text(std::size_t offset, std::size_t length) const {
        return {reinterpret_cast<const char*>(part(offset, length).data()), length};
    }

    /// Offset of the end record, after which a comment may follow.
    [[nodiscard]] std::size_t end() const {
        constexpr std::size_t kMaxComment = 65535;
        if (bytes_.size() < kEndBytes) damaged();
        const std::size_t last = bytes_.size() - kEndBytes;
        for (std::size_t at = last;; --at) {
            if (number<std::uint32_t>(at) == kEnd) return at;
            if (at == 0 || last - at == kMaxComment) damaged();
        }
    }

    [[noreturn]] void damaged() const {
        throw InputError(where_, "is no whole .npz file: it is cut off or damaged");
    }

  private:
    std::span<const std::uint8_t> bytes_;
    const std::string& where_;
};

/// An array of an archive.
struct Member {
    std::uint16_t flags = 0, method = 0;
    std::uint32_t crc = 0, packed_bytes = 0, bytes = 0, offset = 0;
};

/// \throws InputError if there is none of this name.
Member find(const Archive& archive, std::string_view name, const std::string& where) {
    const std::size_t end = archive.end();
    const int count = archive.number<std::uint16_t>(end + 10);
    std::size_t at = archive.number<std::uint32_t>(end + 16);
    std::string names;
    for (int i = 0; i < count; ++i) {
        if (archive.number<std::uint32_t>(at) != kEntry) archive.damaged();
        const std::size_t name_bytes = archive.number<std::uint16_t>(at + 28);
        std::string_view found = archive.text(at + kEntryBytes, name_bytes);
        if (found.ends_with(".npy")) found.remove_suffix(4);
        if (found == name)
            return {.flags = archive.number<std::uint16_t>(at + 8),
                    .method = archive.number<std::uint16_t>(at + 10),
                    .crc = archive.number<std::uint32_t>(at + 16),
                    .packed_bytes = archive.number<std::uint32_t>(at + 20),
                    .bytes = archive.number<std::uint32_t>(at + 24),
                    .offset = archive.number<std::uint32_t>(at + 42)};
        if (i < static_cast<int>(kMaxListed))
            names += fmt::format("{}\"{}\"", names.empty() ? "" : ", ", found);
        at += kEntryBytes + name_bytes + archive.number<std::uint16_t>(at + 30) +
              archive.number<std::uint16_t>(at + 32);
    }
    if (count > static_cast<int>(kMaxListed)) names += ", ...";
    throw InputError(fmt::format("{}: array \"{}\"", where, name),
                     fmt::format("is missing; the file holds {}; other names: ",
                                 names.empty() ? "no array" : names) +
                         Parameter{"variable"} + ", " + Parameter{"mask_variable"});
}

/// The bytes of a deflated member. False unless they are as many as `bytes` has.
bool inflate_all(std::span<const std::uint8_t> packed, std::span<std::uint8_t> bytes) {
    z_stream stream{};
    constexpr int kRaw = -15;  // largest window, without a header of zlib
    if (inflateInit2(&stream, kRaw) != Z_OK) throw std::bad_alloc();
    stream.next_in = const_cast<Bytef*>(packed.data());
    stream.avail_in = static_cast<uInt>(packed.size());
    stream.next_out = bytes.data();
    stream.avail_out = static_cast<uInt>(bytes.size());
    const int result = inflate(&stream, Z_FINISH);
    const bool whole = result == Z_STREAM_END && stream.avail_out == 0;
    inflateEnd(&stream);
    return whole;
}

}  // namespace

bool is_npz(const std::filesystem::path& file) {
    std::string extension = file.extension().string();
    std::ranges::transform(extension, extension.begin(),
                           [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return extension == ".npz";
}

NpyVolume parse_npz_volume(std::span<const std::uint8_t> bytes, const std::string& where,
                           std::string_view name, NpyImages images) {
    constexpr std::uint16_t kEncrypted = 1, kStored = 0, kDeflated = 8;
    const Archive archive(bytes, where);
    const Member member = find(archive, name, where);
    const std::string what = fmt::format("{}: array \"{}\"", where, name);
    if ((member.flags & kEncrypted) != 0 ||
        (member.method != kStored && member.method != kDeflated))
        throw InputError(what, "is encrypted or packed in an unknown way; save it by numpy.savez");
    if (archive.number<std::uint32_t>(member.offset) != kLocal) archive.damaged();
    const std::size_t begin = member.offset + kLocalBytes +
                              archive.number<std::uint16_t>(member.offset + 26) +
                              archive.number<std::uint16_t>(member.offset + 28);
    std::span<const std::uint8_t> content = archive.part(begin, member.packed_bytes);
    std::vector<std::uint8_t> unpacked;
    if (member.method == kDeflated) {
        check_memory(member.bytes, what, "the array", bytes.size());
        unpacked.resize(member.bytes);
        if (!inflate_all(content, unpacked))
            throw InputError(what, "cannot be unpacked; the file is damaged");
        content = unpacked;
    }
    if (crc32_z(0, content.data(), content.size()) != member.crc)
        throw InputError(what, "has a wrong checksum; the file is damaged");
    return parse_npy_volume(std::as_bytes(content), what, images);
}

NpyVolume read_npz_volume(const std::filesystem::path& file, std::string_view name,
                          NpyImages images) {
    if (const std::uint64_t bytes = input_bytes(file); bytes != kEndlessInput)
        check_memory(bytes, file.string(), "the file");
    return parse_npz_volume(read_file(file), file.string(), name, images);
}

}  // namespace stipple
