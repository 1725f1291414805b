#include "io/output_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>
#include <utility>

#include "core/error.h"
#include "io/output_names.h"

namespace stipple {

OutputFile::OutputFile(const std::filesystem::path& path, std::string where)
    : where_(std::move(where)) {
    // Not through a link that somebody has put there, unless to a pipe, as /dev/fd/N is.
    constexpr int kMode = O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC;
    const int descriptor =
        path == "-" ? ::dup(STDOUT_FILENO)
                    : ::open(path.c_str(), kMode | (is_pipe(path) ? 0 : O_NOFOLLOW), 0666);
    if (descriptor >= 0) file_.reset(::fdopen(descriptor, "wb"));
    if (!file_) fail();
}

void OutputFile::write(std::span<const std::byte> bytes) {
    if (std::fwrite(bytes.data(), 1, bytes.size(), file_.get()) != bytes.size()) fail();
}

void OutputFile::seek(long offset) {
    if (std::fseek(file_.get(), offset, SEEK_SET) != 0) fail();
}

void OutputFile::close() {
    if (std::fclose(file_.release()) != 0) fail();
}

void OutputFile::fail() const {
    if (errno == EPIPE) throw std::system_error(errno, std::generic_category(), where_);
    throw write_failure(where_, errno);
}

}  // namespace stipple
