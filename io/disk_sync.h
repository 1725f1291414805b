#pragma once

#include <filesystem>

namespace stipple {

/// Returns when the content of a file, or the names in a folder, are on the disk. What cannot be
/// synced (a pipe, a file system that is read-only, a folder that may not be read) is left to the
/// system. \throws std::filesystem::filesystem_error (EIO, ENOSPC).
void sync_to_disk(const std::filesystem::path& file_or_folder);

/// The same for a file, or for a folder and all that is in it.
void sync_all_to_disk(const std::filesystem::path& file_or_folder);

/// While it lives, this thread's calls of the above return at once: for those who can afford to
/// lose their outputs with the power.
class NoSync {
  public:
    NoSync();
    ~NoSync();
    NoSync(const NoSync&) = delete;
    NoSync& operator=(const NoSync&) = delete;
};

}  // namespace stipple
