#include "stream/buffered_reader.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cassert>
#include <cerrno>
#include <system_error>

#include "core/error.h"

namespace stipple {
namespace {

constexpr std::size_t kStepBytes = std::size_t{1} << 18U;

}  // namespace

BufferedReader::BufferedReader(const std::filesystem::path& file, EmptyPipe empty_pipe)
    : where_(file.string()),
      descriptor_(::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)),
      waits_(empty_pipe == EmptyPipe::kWait) {
    if (descriptor_ < 0) fail();
    struct stat status {};
    is_pipe_ = ::fstat(descriptor_, &status) == 0 && S_ISFIFO(status.st_mode);
    if (!is_pipe_) ::fcntl(descriptor_, F_SETFL, ::fcntl(descriptor_, F_GETFL) & ~O_NONBLOCK);
}

BufferedReader::~BufferedReader() {
    ::close(descriptor_);
}

std::span<const std::uint8_t> BufferedReader::peek(std::size_t bytes) {
    while (end_ - begin_ < bytes) {
        // No more than doubles what is there: a length is only a claim until the bytes come.
        const std::size_t missing = bytes - (end_ - begin_);
        make_room(std::max(kStepBytes, std::min(missing, end_ - begin_)));
        const std::size_t got = read_some(buffer_.data() + end_, buffer_.size() - end_);
        if (got == 0) break;
        end_ += got;
    }
    return std::span(buffer_).subspan(begin_, std::min(bytes, end_ - begin_));
}

std::size_t BufferedReader::read_some(std::uint8_t* to, std::size_t bytes) {
    // Of a pipe that no program writes to, a read returns 0: at its end, and before its writer
    // comes. Only poll() tells them apart: POLLHUP is raised once a writer has come and gone.
    for (bool writer_has_gone = false;;) {
        const auto got = ::read(descriptor_, to, bytes);
        if (got > 0) return static_cast<std::size_t>(got);
        if (got < 0 && errno == EINTR) continue;
        if (got < 0 && errno != EAGAIN) fail();
        if (!is_pipe_ || !waits_ || (got == 0 && writer_has_gone)) return 0;
        pollfd pipe{.fd = descriptor_, .events = POLLIN, .revents = 0};
        if (::poll(&pipe, 1, -1) < 0) fail();
        writer_has_gone = (pipe.revents & POLLHUP) != 0;
    }
}

void BufferedReader::make_room(std::size_t bytes) {
    if (buffer_.size() - end_ >= bytes) return;
    std::copy(buffer_.begin() + static_cast<std::ptrdiff_t>(begin_),
              buffer_.begin() + static_cast<std::ptrdiff_t>(end_), buffer_.begin());
    end_ -= begin_;
    begin_ = 0;
    if (buffer_.size() - end_ < bytes) buffer_.resize(end_ + bytes);
}

void BufferedReader::skip(std::size_t bytes) {
    assert(bytes <= end_ - begin_);
    begin_ += bytes;
    offset_ += bytes;
}

void BufferedReader::seek(std::uint64_t offset) {
    if (::lseek(descriptor_, static_cast<off_t>(offset), SEEK_SET) < 0) fail();
    offset_ = offset;
    begin_ = end_ = 0;
}

std::optional<std::uint64_t> BufferedReader::file_bytes() const {
    struct stat status {};
    if (::fstat(descriptor_, &status) != 0 || !S_ISREG(status.st_mode)) return std::nullopt;
    return static_cast<std::uint64_t>(status.st_size);
}

std::optional<std::vector<std::uint8_t>> BufferedReader::read_at(std::uint64_t offset,
                                                                 std::size_t bytes) const {
    const auto length = file_bytes();
    if (!length || offset > *length || *length - offset < bytes) return std::nullopt;
    std::vector<std::uint8_t> result(bytes);
    for (std::size_t done = 0; done < bytes;) {
        const auto got = ::pread(descriptor_, result.data() + done, bytes - done,
                                 static_cast<off_t>(offset + done));
        if (got < 0 && errno == EINTR) continue;
        if (got < 0) fail();
        if (got == 0) return std::nullopt;
        done += static_cast<std::size_t>(got);
    }
    return result;
}

void BufferedReader::fail() const {
    throw InputError(where_, "cannot be read: " + std::generic_category().message(errno));
}

}  // namespace stipple
