#include "io/file_bytes.h"

#include <fmt/format.h>

#include <cerrno>
#include <system_error>

#include "core/error.h"
#include "core/input_file.h"

namespace stipple {
namespace {

[[noreturn]] void fail(const std::string& name, const std::string& why) {
    throw InputError(name, "cannot be read: " + why);
}

}  // namespace

RandomAccessFile::RandomAccessFile(const std::filesystem::path& file) : name_(file.string()) {
    refuse_special(file);
    file_.reset(std::fopen(file.c_str(), "rb"));
    if (!file_) fail(name_, std::generic_category().message(errno));
    std::error_code error;
    size_ = std::filesystem::file_size(file, error);
    if (error) fail(name_, error.message());
}

void RandomAccessFile::read(std::uint64_t offset, std::span<std::uint8_t> bytes) {
    if (offset > size_ || bytes.size() > size_ - offset)
        throw InputError(name_, fmt::format("ends at byte {}, but {} bytes are announced at {}; it "
                                            "is damaged or cut short",
                                            size_, bytes.size(), offset));
    if (fseeko(file_.get(), static_cast<off_t>(offset), SEEK_SET) != 0)
        fail(name_, std::generic_category().message(errno));
    if (std::fread(bytes.data(), 1, bytes.size(), file_.get()) == bytes.size()) return;
    if (std::ferror(file_.get()) != 0) fail(name_, std::generic_category().message(errno));
    throw InputError(name_, "was cut short while it was read");
}

}  // namespace stipple
