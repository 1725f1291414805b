#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace stipple {

/// Kind of a folder that several runs fill with the parts of one result. A file in it, the
/// identity, holds all that determines the result, so that no part of another one gets in.
struct SharedFolderKind {
    const char* identity;  ///< name of the file
    const char* article;   ///< of the result
    const char* result;    ///< "decoding"
    const char* verb;      ///< "decode"
    const char* parts;     ///< "windows"
};

inline constexpr SharedFolderKind kDecodingFolder{"decoding.json", "a", "decoding", "decode",
                                                  "windows"};
inline constexpr SharedFolderKind kEmulationFolder{"emulation.json", "an", "emulation", "emulate",
                                                   "pieces"};

/// Whether the folder has the identity. Writes nothing, so that a run that is refused leaves
/// nothing. \throws InputError if the folder holds parts of another result, or anything else, or
/// cannot be made.
[[nodiscard]] bool has_identity(const std::filesystem::path& folder, const SharedFolderKind& kind,
                                const nlohmann::ordered_json& identity);

/// Makes the folder and writes the identity, unless they are there. Several processes may do so at
/// the same time. \throws InputError as has_identity; DeviceError if it cannot be written.
void claim_folder(const std::filesystem::path& folder, const SharedFolderKind& kind,
                  const nlohmann::ordered_json& identity);

/// The identity of a folder, with the keys and the types of `pattern`. \throws InputError, as for a
/// link in the folder.
[[nodiscard]] nlohmann::ordered_json read_identity(const std::filesystem::path& folder,
                                                   const SharedFolderKind& kind,
                                                   const nlohmann::ordered_json& pattern);

/// The first key in which two identities differ, as text; empty if there is none.
[[nodiscard]] std::string first_difference(const nlohmann::ordered_json& there,
                                           const nlohmann::ordered_json& here);

/// The identity as the folder has it.
[[nodiscard]] std::string identity_text(const std::filesystem::path& folder,
                                        const SharedFolderKind& kind);

/// Removes what killed runs have left of a file.
void remove_leftovers(const std::filesystem::path& file);

/// The parts of a folder, numbered from 0: their files, and whether a file is there and complete.
struct NumberedParts {
    std::int64_t count = 0;
    std::function<std::filesystem::path(std::int64_t)> file;
    std::function<bool(std::int64_t)> holds;

    /// Those that are not there, of [begin, end).
    [[nodiscard]] std::vector<std::int64_t> missing(std::int64_t begin, std::int64_t end) const;
    /// \throws InputError naming the files that are missing.
    void require_all(const std::filesystem::path& folder, const SharedFolderKind& kind) const;
};

}  // namespace stipple
