#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string_view>

namespace stipple {

/// A managed file lies in a folder that the program fills, so no user has made it a link.
enum class OutputKind { kFile, kFolder, kManagedFile };

/// Whether a run of this kind writes a file with this name into its folder.
using IsOwnName = bool (*)(std::string_view name);
/// frame_0000.exr, light_0000.png, light_0000.tif ... Others name their frames frame_0000.png too.
[[nodiscard]] bool is_frame_name(std::string_view name);

/// An output that gets its final name only when it is complete and on the disk
/// (docs/reliability.md). Write to `partial()`, then call `commit()`; without `commit` the
/// destructor removes the partial file or folder.
class PendingOutput {
  public:
    /// Creates the folder `partial()` if `kind` is a folder. A link to a file stands for this file,
    /// but in place of a managed file it is refused.
    /// \throws InputError if `final_path` exists and not `force`, or if its parent folder is
    /// missing. An empty folder is replaced by a folder. With `force` a regular file is replaced by
    /// a file, and a folder that contains only files with names of this program by a folder; for
    /// anything else InputError, because it may be somebody's work. \throws DeviceError if the
    /// folder cannot be created.
    PendingOutput(const std::filesystem::path& final_path, bool force,
                  OutputKind kind = OutputKind::kFile, IsOwnName is_own = is_frame_name);
    ~PendingOutput();
    PendingOutput(const PendingOutput&) = delete;
    PendingOutput& operator=(const PendingOutput&) = delete;

    [[nodiscard]] const std::filesystem::path& final_path() const { return final_; }
    /// Path to write to: in the same folder, hidden, with the same extension, the process number
    /// and a random number. The first call creates it, empty. \throws DeviceError.
    [[nodiscard]] const std::filesystem::path& partial() const;
    /// Waits until the partial output is on the disk (but see NoSync), and gives it its final name.
    /// \throws DeviceError if that fails; then the partial output and the old output are kept.
    /// \throws std::bad_alloc likewise. If another program has created a file with this name
    /// meanwhile, and not `force`, the output is named "name_2.ext" or similar. The message gives
    /// the name.
    void commit();
    [[nodiscard]] bool committed() const { return committed_; }
    /// Whether `commit` was called: the output is kept, under some name.
    [[nodiscard]] bool kept() const { return kept_; }

  private:
    void check_replaceable() const;
    void create_partial() const;
    void unregister();
    [[nodiscard]] bool remove_partial() const noexcept;
    [[nodiscard]] bool rename_to_final();
    [[nodiscard]] std::filesystem::path rename_to_fallback() const;
    void settle(const std::filesystem::path& name);

    std::filesystem::path final_;
    std::filesystem::path partial_;
    bool force_;
    OutputKind kind_;
    IsOwnName is_own_;
    mutable bool created_ = false;
    bool kept_ = false;      ///< not removed by the destructor
    bool replaced_ = false;  ///< partial_ is now the folder that was final_
    bool committed_ = false;
    std::unique_ptr<char[]> listed_;  ///< partial_, for the list, which may outlive this object
    std::size_t place_in_list_;       ///< in the list of partial outputs that no message names
};

/// \throws InputError if a folder that the program fills holds a link: whoever made it would choose
/// the file that is read or replaced.
void refuse_links(const std::filesystem::path& folder);

/// Calls `visit` with the partial path of each output that is neither committed nor removed, nor
/// named in an exception; only with the first ones if there are more than some dozens. Safe in a
/// signal handler.
void visit_partial_outputs(void (*visit)(const char* path)) noexcept;

}  // namespace stipple
