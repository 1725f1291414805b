#pragma once

#include <filesystem>
#include <optional>
#include <vector>

namespace stipple {

/// An output that is not yet complete, as its hidden name says: ".name.PROCESS.partial.ext" for
/// "name.ext" (docs/cli.md). It stays where its process was killed.
struct PartialOutput {
    std::filesystem::path path;
    std::filesystem::path final_path;
    int process = 0;

    /// Whether a process of that number and of this program's name is there, which began before the
    /// output was last written.
    [[nodiscard]] bool running() const;
};

/// The path to which process `process` writes `final_path`, until it is complete.
[[nodiscard]] std::filesystem::path partial_path(const std::filesystem::path& final_path,
                                                 int process);

/// What the name of `path` says; nothing if it is not one of a partial output.
[[nodiscard]] std::optional<PartialOutput> partial_output(const std::filesystem::path& path);

/// All of a folder, by name; none if it cannot be listed.
[[nodiscard]] std::vector<PartialOutput> partial_outputs(const std::filesystem::path& folder);

/// The partial output, in its folder, of a program that is writing `final_path`, or that was killed
/// while it did; the newest of several.
[[nodiscard]] std::optional<std::filesystem::path> partial_of(
    const std::filesystem::path& final_path);

/// Renames, unless the name is taken: false. Never replaces anything.
/// \throws std::filesystem::filesystem_error.
[[nodiscard]] bool rename_to_free_name(const std::filesystem::path& from,
                                       const std::filesystem::path& to);

}  // namespace stipple
