#include "stream/append_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <utility>

#include "core/error.h"

namespace stipple {

AppendFile::AppendFile(const std::filesystem::path& file, std::string where)
    : where_(std::move(where)),
      descriptor_(
          ::open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_NOFOLLOW | O_CLOEXEC, 0666)) {
    if (descriptor_ < 0) fail();
}

AppendFile::~AppendFile() {
    if (descriptor_ >= 0) ::close(descriptor_);
}

void AppendFile::append(std::span<const std::uint8_t> bytes) {
    while (!bytes.empty()) {
        const auto written = ::write(descriptor_, bytes.data(), bytes.size());
        if (written < 0 && errno == EINTR) continue;
        if (written < 0) fail();
        bytes_ += static_cast<std::uint64_t>(written);
        bytes = bytes.subspan(static_cast<std::size_t>(written));
    }
}

void AppendFile::close() {
    if (::close(std::exchange(descriptor_, -1)) != 0) fail();
}

void AppendFile::cut(std::uint64_t bytes) noexcept {
    const auto end = static_cast<off_t>(bytes);
    if (::ftruncate(descriptor_, end) == 0 && ::lseek(descriptor_, end, SEEK_SET) == end)
        bytes_ = bytes;
}

void AppendFile::fail() const {
    throw write_failure(where_, errno);
}

}  // namespace stipple
