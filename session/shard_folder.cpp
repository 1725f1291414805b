#include "session/shard_folder.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstddef>
#include <fstream>
#include <iterator>
#include <random>
#include <system_error>

#include "core/error.h"
#include "io/disk_sync.h"
#include "io/partial_output.h"
#include "io/pending_output.h"
#include "io/text_file.h"

namespace stipple {
namespace fs = std::filesystem;
namespace {

/// Gives `file` the content `text`, unless it exists: then another process was first.
void publish(const fs::path& file, const std::string& text) {
    const fs::path partial = partial_path(file, getpid(), std::random_device{}());
    write_whole(partial, file.string(), text);
    try {
        if (!rename_to_free_name(partial, file)) fs::remove(partial);
        sync_to_disk(file.parent_path());
    } catch (const fs::filesystem_error& e) {
        throw DeviceError(file.string(), "cannot be written: " + e.code().message());
    }
}

std::string text_of(const fs::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

std::string differing(const std::string& key, const nlohmann::ordered_json& there,
                      const nlohmann::ordered_json& here) {
    return fmt::format("{} is {} there and {} here", key, there.dump(), here.dump());
}

}  // namespace

bool has_identity(const fs::path& folder, const ShardFolderKind& kind,
                  const nlohmann::ordered_json& identity) {
    std::error_code error;
    if (!fs::exists(folder, error)) {
        const fs::path parent = folder_of(folder.has_filename() ? folder : folder.parent_path());
        if (fs::is_directory(parent, error)) return false;
        throw InputError(folder.string(), "cannot be made: there is no folder to make it in");
    }
    if (!fs::is_directory(folder, error)) throw InputError(folder.string(), "is not a folder");
    refuse_links(folder);
    if (!fs::exists(folder / kind.identity)) {
        for (const fs::directory_entry& entry : fs::directory_iterator(folder))
            if (!partial_output(entry.path()) && entry.path().filename() != kind.identity)
                throw InputError(
                    folder.string(),
                    fmt::format("holds {}, so it is not a folder of {}; give another name",
                                entry.path().filename().string(), kind.parts));
        return false;
    }
    const auto there =
        parsed_identity(stored_identity(folder, kind), folder / kind.identity, kind, identity);
    const std::string other = first_difference(there, identity);
    if (!other.empty())
        throw InputError(folder.string(),
                         fmt::format("holds another {}: {}; give another name, or remove it",
                                     kind.result, other));
    return true;
}

void claim_folder(const fs::path& folder, const ShardFolderKind& kind,
                  const nlohmann::ordered_json& identity) {
    if (has_identity(folder, kind, identity)) return;
    std::error_code error;
    if (fs::create_directory(folder, error)) sync_to_disk(folder / "..");
    if (error) throw InputError(folder.string(), "cannot be made: " + error.message());
    publish(folder / kind.identity, identity.dump(2) + "\n");
    static_cast<void>(
        has_identity(folder, kind, identity));  // that of another run, if it was first
}

std::string stored_identity(const fs::path& folder, const ShardFolderKind& kind) {
    refuse_links(folder);
    const fs::path file = folder / kind.identity;
    if (!fs::exists(file))
        throw InputError(folder.string(),
                         fmt::format("has no {}: it is not the folder of {} {} in {}",
                                     kind.identity, kind.article, kind.result, kind.parts));
    return text_of(file);
}

nlohmann::ordered_json parsed_identity(const std::string& text, const fs::path& file,
                                       const ShardFolderKind& kind,
                                       const nlohmann::ordered_json& pattern) {
    auto json = nlohmann::ordered_json::parse(text, nullptr, false);
    bool whole = json.is_object();
    const auto same_kind = [](const auto& found, const auto& wanted) {
        if (wanted.is_number_integer()) return found.is_number_integer();
        return wanted.is_number() ? found.is_number() : found.type() == wanted.type();
    };
    for (const auto& [key, value] : pattern.items())
        whole = whole && json.contains(key) && same_kind(json[key], value);
    if (!whole)
        throw InputError(file.string(), fmt::format("does not describe {} {}; remove the "
                                                    "folder, and {} again",
                                                    kind.article, kind.result, kind.verb));
    return json;
}

std::string first_difference(const nlohmann::ordered_json& there,
                             const nlohmann::ordered_json& here) {
    for (const auto& [key, value] : here.items()) {
        const nlohmann::ordered_json& other = there[key];
        if (other == value) continue;
        if (value.is_array() && other.is_array())
            for (std::size_t i = 0; i < std::min(other.size(), value.size()); ++i)
                if (other[i] != value[i]) return differing(key, other[i], value[i]);
        return differing(key, other, value);
    }
    return {};
}

void remove_leftovers(const fs::path& file) {
    std::error_code error;
    for (const PartialOutput& partial : partial_outputs(folder_of(file)))
        if (partial.final_path.filename() == file.filename() && !partial.running())
            fs::remove(partial.path, error);
}

}  // namespace stipple
