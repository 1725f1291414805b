#pragma once

#include <filesystem>

namespace stipple {

/// Returns when the content of a file, or the names in a folder, are on the disk. Pipes, files on
/// read-only file systems and folders without read permission cannot be synced; they are left to
/// the system. \throws std::filesystem::filesystem_error (EIO, ENOSPC).
void sync_to_disk(const std::filesystem::path& file_or_folder);

/// Syncs a file, or a folder and all its content.
void sync_all_to_disk(const std::filesystem::path& file_or_folder);

/// During the life of this object the functions above return at once in this thread: for runs whose
/// outputs may be lost in a power failure.
class NoSync {
  public:
    NoSync();
    ~NoSync();
    NoSync(const NoSync&) = delete;
    NoSync& operator=(const NoSync&) = delete;
};

}  // namespace stipple
