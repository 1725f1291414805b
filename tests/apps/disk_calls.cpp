// Preloaded (LD_PRELOAD), this writes the calls by which a program puts its outputs on the disk and
// in place to the file DISK_CALLS, a line each: what, and of which path. A sync of a path of the
// pattern FAILING_SYNC fails with the number FAILING_ERRNO. With OLD_FILE_SYSTEM renames with flags
// are not known.

#include <fcntl.h>
#include <fnmatch.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "tests/apps/preloaded.h"

namespace {

void note(const std::string& line) {
    const char* const log = std::getenv("DISK_CALLS");
    if (log == nullptr) return;
    const int file = open(log, O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
    if (write(file, line.data(), line.size()) < 0) std::perror("DISK_CALLS");
    close(file);
}

std::string path_of(int descriptor) {
    std::string path(4096, '\0');
    const std::string link = "/proc/self/fd/" + std::to_string(descriptor);
    const auto length = readlink(link.c_str(), path.data(), path.size());
    path.resize(length < 0 ? 0 : static_cast<std::size_t>(length));
    return path;
}

}  // namespace

extern "C" int fsync(int descriptor) {
    const std::string path = path_of(descriptor);
    note("sync " + path + "\n");
    const char* const failing = std::getenv("FAILING_SYNC");
    if (failing == nullptr || fnmatch(failing, path.c_str(), 0) != 0)
        return next<int(int)>("fsync")(descriptor);
    errno = std::atoi(std::getenv("FAILING_ERRNO"));
    return -1;
}

extern "C" int rename(const char* from, const char* to) noexcept {
    note(std::string("rename ") + to + "\n");
    return next<int(const char*, const char*)>("rename")(from, to);
}

extern "C" int renameat2(int from_folder, const char* from, int to_folder, const char* to,
                         unsigned flags) noexcept {
    if (std::getenv("OLD_FILE_SYSTEM") != nullptr) {
        errno = EINVAL;
        return -1;
    }
    note(std::string("rename ") + to + "\n");
    return next<int(int, const char*, int, const char*, unsigned)>("renameat2")(
        from_folder, from, to_folder, to, flags);
}
