#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string_view>

namespace stipple {

enum class OutputKind { kFile, kFolder };

/// Whether a run of this kind writes a file of this name into its folder.
using IsOwnName = bool (*)(std::string_view name);
/// frame_0000.exr ...
[[nodiscard]] bool is_frame_name(std::string_view name);

/// An output that appears under its final name only when it is complete and on the disk
/// (docs/reliability.md). Write to `partial()`, then `commit()`; if it is destroyed without, the
/// partial file or folder is removed.
class PendingOutput {
  public:
    /// Creates the folder `partial()` if `kind` is a folder. A link to a file stands for that file.
    /// \throws InputError if `final_path` exists and not `force`, or if its parent folder is
    /// missing. An empty folder gives way to a folder. With `force` a regular file gives way to a
    /// file, and a folder that holds nothing but files of our own names to a folder; anything else
    /// is an InputError, because it may be somebody's work. \throws DeviceError if the folder
    /// cannot be created.
    PendingOutput(const std::filesystem::path& final_path, bool force,
                  OutputKind kind = OutputKind::kFile, IsOwnName is_own = is_frame_name);
    ~PendingOutput();
    PendingOutput(const PendingOutput&) = delete;
    PendingOutput& operator=(const PendingOutput&) = delete;

    [[nodiscard]] const std::filesystem::path& final_path() const { return final_; }
    /// Path to write to: in the same folder, hidden, with the same extension, the process number
    /// and a random one. Once asked for it is there, new and empty. \throws DeviceError.
    [[nodiscard]] const std::filesystem::path& partial() const;
    /// Waits until the partial output is on the disk (but see NoSync), and moves it to its final
    /// name. \throws DeviceError if that fails; the partial output is then kept, and an output that
    /// was to be replaced too. \throws std::bad_alloc likewise. If another program has made a file
    /// of that name since, and not `force`, what was written is kept as "name_2.ext" or so on. The
    /// message says where.
    void commit();
    [[nodiscard]] bool committed() const { return committed_; }
    /// Whether `commit` was called: what was written stays, under whichever name.
    [[nodiscard]] bool kept() const { return kept_; }

  private:
    void check_replaceable() const;
    void create_partial() const;
    void unlist();
    [[nodiscard]] bool remove_partial() const noexcept;
    [[nodiscard]] bool put_in_place();
    [[nodiscard]] std::filesystem::path put_beside() const;
    void settle(const std::filesystem::path& name);

    std::filesystem::path final_;
    std::filesystem::path partial_;
    bool force_;
    OutputKind kind_;
    IsOwnName is_own_;
    mutable bool created_ = false;
    bool kept_ = false;      ///< whatever becomes of this object
    bool replaced_ = false;  ///< partial_ is now the folder that was final_
    bool committed_ = false;
    std::unique_ptr<char[]> listed_;  ///< partial_, for the list, which may outlive this object
    std::size_t place_in_list_;       ///< of partial outputs that no message names
};

/// Calls `visit` with the partial path of each output that is neither committed nor removed, nor
/// told in an exception; of more than some dozens with the first ones. Safe in a signal handler.
void visit_partial_outputs(void (*visit)(const char* path)) noexcept;

}  // namespace stipple
