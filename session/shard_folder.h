#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "session/shard.h"

namespace stipple {

/// Whether the folder has the identity. Writes nothing, so that a run that is refused leaves
/// nothing. \throws InputError if the folder holds parts of another result, or anything else, or
/// cannot be made.
[[nodiscard]] bool has_identity(const std::filesystem::path& folder, const ShardFolderKind& kind,
                                const nlohmann::ordered_json& identity);

/// Makes the folder and writes the identity, unless they are there. Several processes may do so at
/// the same time. \throws InputError as has_identity; DeviceError if it cannot be written.
void claim_folder(const std::filesystem::path& folder, const ShardFolderKind& kind,
                  const nlohmann::ordered_json& identity);

/// The text of the identity of a folder. \throws InputError without one, or if a link is in the
/// folder.
[[nodiscard]] std::string stored_identity(const std::filesystem::path& folder,
                                          const ShardFolderKind& kind);

/// The identity in `text`, which `file` has, with the keys and the types of `pattern`.
/// \throws InputError.
[[nodiscard]] nlohmann::ordered_json parsed_identity(const std::string& text,
                                                     const std::filesystem::path& file,
                                                     const ShardFolderKind& kind,
                                                     const nlohmann::ordered_json& pattern);

/// The first key in which two identities differ, as text; empty if there is none.
[[nodiscard]] std::string first_difference(const nlohmann::ordered_json& there,
                                           const nlohmann::ordered_json& here);

/// Removes what killed runs have left of a file.
void remove_leftovers(const std::filesystem::path& file);

}  // namespace stipple
