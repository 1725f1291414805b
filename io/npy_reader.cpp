#include "io/npy_file.h"

#include <fmt/format.h>
#include <half.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cerrno>
#include <cstdint>
#include <system_error>

#include "core/error.h"
#include "io/interleaved.h"

namespace stipple {
namespace {

static_assert(std::endian::native == std::endian::little, ".npy data are read as they lie");

struct Cast {
    template <typename Value>
    float operator()(Value value) const {
        return static_cast<float>(value);
    }
};

void to_planes(std::span<const std::byte> bytes, const NpyHeader& header, std::span<float> frame) {
    const int planes = header.shape.planes;
    switch (header.type) {
        case NpyType::kUint8:
            return split_planes<std::uint8_t>(bytes, planes, planes, frame, UnitScale());
        case NpyType::kUint16:
            return split_planes<std::uint16_t>(bytes, planes, planes, frame, UnitScale());
        case NpyType::kHalf:
            return split_planes<half>(bytes, planes, planes, frame, Cast());
        case NpyType::kFloat:
            return split_planes<float>(bytes, planes, planes, frame, Cast());
        case NpyType::kDouble:
            return split_planes<double>(bytes, planes, planes, frame, Cast());
    }
}

[[noreturn]] void fail(const std::string& where) {
    throw InputError(where, "cannot be read: " + std::generic_category().message(errno));
}

}  // namespace

NpyReader::NpyReader(const std::filesystem::path& file)
    : name_(file.string()), file_(std::fopen(file.c_str(), "rb")) {
    if (!file_) fail(name_);
    std::error_code error;
    const std::uint64_t file_bytes = std::filesystem::file_size(file, error);
    if (error) throw InputError(name_, "cannot be read: " + error.message());
    std::vector<std::byte> start(std::min<std::uint64_t>(file_bytes, kMaxNpyHeaderBytes));
    start.resize(std::fread(start.data(), 1, start.size(), file_.get()));
    if (std::ferror(file_.get()) != 0) fail(name_);
    header_ = parse_npy_header(start, file_bytes, name_);
    bytes_.resize(header_.frame_bytes());
    if (std::fseek(file_.get(), static_cast<long>(header_.data_offset), SEEK_SET) != 0) fail(name_);
}

SourceInfo NpyReader::traits() const {
    constexpr std::array<const char*, 5> kNames{"uint8", "uint16", "float16", "float32", "float64"};
    SourceInfo traits;
    traits.sample_format = kNames[static_cast<std::size_t>(header_.type)];
    if (header_.type == NpyType::kUint8) traits.bits = 8;
    if (header_.type == NpyType::kUint16) traits.bits = 16;
    return traits;
}

std::string NpyReader::where() const {
    return fmt::format("{}: frame {}", name_, next_slot_ - 1);
}

bool NpyReader::read(std::span<float> frame) {
    if (next_slot_ == header_.slots) return false;
    ++next_slot_;
    const bool whole = std::fread(bytes_.data(), 1, bytes_.size(), file_.get()) == bytes_.size();
    if (std::ferror(file_.get()) != 0) fail(where());
    if (!whole)
        throw InputError(where(), "cannot be read; the file was cut short while it was read");
    to_planes(bytes_, header_, frame);
    return true;
}

void NpyReader::skip(int frames) {
    const int skipped = std::min(frames, header_.slots - next_slot_);
    next_slot_ += skipped;
    const auto bytes = static_cast<long>(bytes_.size()) * skipped;
    if (std::fseek(file_.get(), bytes, SEEK_CUR) != 0) fail(name_);
}

}  // namespace stipple
