#pragma once

#include <filesystem>

namespace stipple {

/// An output that appears under its final name only when it is complete. Write to `partial()`,
/// then `commit()`; if it is destroyed without, the partial file or folder is removed.
class PendingOutput {
  public:
    /// \throws InputError if `final_path` exists and not `force`, or if its parent folder is
    /// missing.
    PendingOutput(std::filesystem::path final_path, bool force);
    ~PendingOutput();
    PendingOutput(const PendingOutput&) = delete;
    PendingOutput& operator=(const PendingOutput&) = delete;

    /// Path to write to, in the same folder and with the same extension.
    [[nodiscard]] const std::filesystem::path& partial() const { return partial_; }
    /// Moves the partial output to its final name. \throws DeviceError.
    void commit();

  private:
    std::filesystem::path final_;
    std::filesystem::path partial_;
    bool committed_ = false;
};

}  // namespace stipple
