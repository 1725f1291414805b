#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

namespace stipple {

/// An incomplete output under its hidden name: ".name.PROCESS-RANDOM.partial.ext" for "name.ext"
/// (docs/outputs.md). It remains if its process is killed.
struct PartialOutput {
    std::filesystem::path path;
    std::filesystem::path final_path;
    int process = 0;

    /// Whether there is a process with this number and the name of this program that began before
    /// the output was last written.
    [[nodiscard]] bool running() const;
};

/// The folder of `path`: "." for a bare name.
[[nodiscard]] std::filesystem::path folder_of(const std::filesystem::path& path);

/// The path to which process `process` writes `final_path` until it is complete. `random`
/// distinguishes two runs with the same process number, and makes the name unpredictable.
[[nodiscard]] std::filesystem::path partial_path(const std::filesystem::path& final_path,
                                                 int process, std::uint32_t random);

/// The partial output that the name of `path` denotes; nothing for other names.
[[nodiscard]] std::optional<PartialOutput> partial_output(const std::filesystem::path& path);

/// All partial outputs of a folder, by name; none if it cannot be listed.
[[nodiscard]] std::vector<PartialOutput> partial_outputs(const std::filesystem::path& folder);

/// The partial output of a program that is writing `final_path`, or was killed while writing it;
/// the newest of several.
[[nodiscard]] std::optional<std::filesystem::path> partial_of(
    const std::filesystem::path& final_path);

/// Exchanges the names of two files or folders at once; false, without any change, if the file
/// system does not support it. \throws std::filesystem::filesystem_error.
[[nodiscard]] bool exchange_names(const std::filesystem::path& a, const std::filesystem::path& b);

/// Renames; false if the name exists. Never replaces anything. \throws
/// std::filesystem::filesystem_error.
[[nodiscard]] bool rename_to_free_name(const std::filesystem::path& from,
                                       const std::filesystem::path& to);

}  // namespace stipple
