#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

namespace stipple {

/// An output that is not yet complete, as its hidden name says: ".name.PROCESS-RANDOM.partial.ext"
/// for "name.ext" (docs/cli.md). It stays where its process was killed.
struct PartialOutput {
    std::filesystem::path path;
    std::filesystem::path final_path;
    int process = 0;

    /// Whether a process of that number and of this program's name is there, which began before the
    /// output was last written.
    [[nodiscard]] bool running() const;
};

/// The folder that `path` is in: "." for a bare name.
[[nodiscard]] std::filesystem::path folder_of(const std::filesystem::path& path);

/// The path to which process `process` writes `final_path`, until it is complete. `random` keeps
/// two runs apart that have the same number, and others from guessing the name.
[[nodiscard]] std::filesystem::path partial_path(const std::filesystem::path& final_path,
                                                 int process, std::uint32_t random);

/// What the name of `path` says; nothing if it is not one of a partial output.
[[nodiscard]] std::optional<PartialOutput> partial_output(const std::filesystem::path& path);

/// All of a folder, by name; none if it cannot be listed.
[[nodiscard]] std::vector<PartialOutput> partial_outputs(const std::filesystem::path& folder);

/// The partial output, in its folder, of a program that is writing `final_path`, or that was killed
/// while it did; the newest of several.
[[nodiscard]] std::optional<std::filesystem::path> partial_of(
    const std::filesystem::path& final_path);

/// Gives each of two files or folders the name of the other at once; false, with nothing done,
/// where the file system does not know how. \throws std::filesystem::filesystem_error.
[[nodiscard]] bool exchange_names(const std::filesystem::path& a, const std::filesystem::path& b);

/// Renames, unless the name is taken: false. Never replaces anything.
/// \throws std::filesystem::filesystem_error.
[[nodiscard]] bool rename_to_free_name(const std::filesystem::path& from,
                                       const std::filesystem::path& to);

}  // namespace stipple
