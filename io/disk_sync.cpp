#include "io/disk_sync.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

namespace stipple {
namespace fs = std::filesystem;
namespace {

thread_local int living_no_syncs = 0;

/// An open file, to be closed whatever comes.
struct Descriptor {
    int number;
    ~Descriptor() {
        if (number >= 0) close(number);
    }
};

[[noreturn]] void fail(const fs::path& path) {
    throw fs::filesystem_error("sync", path, std::error_code(errno, std::generic_category()));
}

int fsync_through_signals(int descriptor) {
    int result = 0;
    do result = fsync(descriptor);
    while (result != 0 && errno == EINTR);
    return result;
}

}  // namespace

NoSync::NoSync() {
    ++living_no_syncs;
}

NoSync::~NoSync() {
    --living_no_syncs;
}

void sync_to_disk(const fs::path& file_or_folder) {
    if (living_no_syncs > 0) return;
    // Not to wait for the other end of a pipe.
    const Descriptor opened{open(file_or_folder.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC)};
    if (opened.number < 0 && errno == EACCES) return;
    if (opened.number < 0) fail(file_or_folder);
    if (fsync_through_signals(opened.number) != 0 && errno != EINVAL && errno != EROFS)
        fail(file_or_folder);
}

void sync_all_to_disk(const fs::path& file_or_folder) {
    if (living_no_syncs > 0) return;
    if (fs::is_directory(fs::symlink_status(file_or_folder)))
        for (const auto& entry : fs::directory_iterator(file_or_folder))
            sync_all_to_disk(entry.path());
    sync_to_disk(file_or_folder);
}

}  // namespace stipple
