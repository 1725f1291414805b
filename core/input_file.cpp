#include "core/input_file.h"

#include <cerrno>
#include <cstddef>
#include <cstdio>
#include <memory>
#include <system_error>

#include "core/error.h"

namespace stipple {
namespace {

struct Closer {
    void operator()(std::FILE* file) const { std::fclose(file); }
};

/// None if it cannot be told; then the file cannot be opened either.
std::filesystem::file_type type_of(const std::filesystem::path& file) {
    std::error_code unknown;
    return std::filesystem::status(file, unknown).type();
}

}  // namespace

void refuse_special(const std::filesystem::path& file) {
    switch (type_of(file)) {
        case std::filesystem::file_type::character:
        case std::filesystem::file_type::block:
        case std::filesystem::file_type::fifo:
        case std::filesystem::file_type::socket:
            throw InputError(file.string(), "is a device, pipe or socket; give a file");
        default:
            break;
    }
}

std::vector<std::uint8_t> read_file(const std::filesystem::path& file) {
    const auto fail = [&] {
        throw InputError(file.string(),
                         "cannot be read: " + std::generic_category().message(errno));
    };
    const auto type = type_of(file);
    if (type == std::filesystem::file_type::character || type == std::filesystem::file_type::block)
        throw InputError(file.string(), "is a device, not a file");
    const std::unique_ptr<std::FILE, Closer> stream(std::fopen(file.c_str(), "rb"));
    if (!stream) fail();
    constexpr std::size_t kStep = std::size_t{1} << 20U;
    std::vector<std::uint8_t> bytes;
    for (std::size_t filled = 0;;) {
        bytes.resize(filled + kStep);
        const std::size_t got = std::fread(bytes.data() + filled, 1, kStep, stream.get());
        filled += got;
        if (got == kStep) continue;
        if (std::ferror(stream.get()) != 0) fail();
        bytes.resize(filled);
        return bytes;
    }
}

}  // namespace stipple
