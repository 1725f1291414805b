#include "apps/window_folder.h"

#include <fmt/format.h>
#include <unistd.h>

#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <random>
#include <system_error>
#include <utility>

#include "apps/report/text_file.h"
#include "core/error.h"
#include "core/version.h"
#include "decoder/block_partition.h"
#include "io/disk_sync.h"
#include "io/npy_reader.h"
#include "io/partial_output.h"

namespace stipple {
namespace fs = std::filesystem;
namespace {

constexpr auto kIdentityName = "decoding.json";
constexpr std::int64_t kMaxSlots = std::int64_t{1} << 53U;  // of a stream
constexpr int kMaxSide = 65535;

nlohmann::ordered_json json_of(const WindowIdentity& identity) {
    return {{"version", version()},
            {"stream_bytes", identity.stream_bytes},
            {"stream_sha256", identity.stream_sha256},
            {"method", identity.method},
            {"options", identity.options},
            {"calibration_sha256", identity.calibration_sha256},
            {"fill_gaps", identity.fill_gaps},
            {"slots", identity.slots},
            {"rows", identity.shape.rows},
            {"cols", identity.shape.cols},
            {"planes", identity.shape.planes},
            {"slot_us", identity.slot_us},
            {"window_slots", kCoreSlots}};
}

/// \throws InputError if `file` is not what json_of writes.
nlohmann::ordered_json read_json(const fs::path& file) {
    std::ifstream stream(file);
    const std::string text(std::istreambuf_iterator<char>(stream), {});
    auto json = nlohmann::ordered_json::parse(text, nullptr, false);
    const nlohmann::ordered_json pattern = json_of({});
    bool whole = json.is_object();
    for (const auto& [key, value] : pattern.items())
        whole = whole && json.contains(key) &&
                (value.is_number() ? json[key].is_number() : json[key].type() == value.type());
    if (!whole)
        throw InputError(file.string(),
                         "does not describe a decoding; remove the folder, and decode again");
    return json;
}

WindowIdentity identity_of(const nlohmann::ordered_json& json, const fs::path& file) {
    WindowIdentity identity{
        .stream_bytes = json["stream_bytes"],
        .stream_sha256 = json["stream_sha256"],
        .method = json["method"],
        .options = json["options"],
        .calibration_sha256 = json["calibration_sha256"],
        .fill_gaps = json["fill_gaps"],
        .slots = json["slots"],
        .shape = {.rows = json["rows"], .cols = json["cols"], .planes = json["planes"]},
        .slot_us = json["slot_us"]};
    const auto side = [](int pixels) { return pixels >= 1 && pixels <= kMaxSide; };
    const FrameShape shape = identity.shape;
    if (identity.slots < 1 || identity.slots > kMaxSlots || !side(shape.rows) ||
        !side(shape.cols) || (shape.planes != 1 && shape.planes != 3))
        throw InputError(file.string(), "has a size that no video has; decode again");
    return identity;
}

/// The first key in which two decodings differ, as text; empty if there is none.
std::string difference(const nlohmann::ordered_json& there, const nlohmann::ordered_json& here) {
    for (const auto& [key, value] : here.items())
        if (there[key] != value)
            return fmt::format("{} is {} there and {} here", key, there[key].dump(), value.dump());
    return {};
}

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

}  // namespace

WindowFolder::WindowFolder(fs::path folder, const WindowIdentity& identity)
    : folder_(std::move(folder)), identity_(identity) {
    std::error_code error;
    if (fs::create_directory(folder_, error)) sync_to_disk(folder_ / "..");
    if (error) throw InputError(folder_.string(), "cannot be made: " + error.message());
    const fs::path file = folder_ / kIdentityName;
    const nlohmann::ordered_json here = json_of(identity);
    if (!fs::exists(file)) {
        for (const fs::directory_entry& entry : fs::directory_iterator(folder_))
            if (!partial_output(entry.path()) && entry.path().filename() != kIdentityName)
                throw InputError(folder_.string(),
                                 fmt::format("holds {}, and is no folder of windows; give another "
                                             "name",
                                             entry.path().filename().string()));
        publish(file, here.dump(2) + "\n");
    }
    const std::string other = difference(read_json(file), here);
    if (!other.empty())
        throw InputError(
            folder_.string(),
            fmt::format("holds another decoding: {}; give another name, or remove it", other));
}

WindowFolder::WindowFolder(fs::path folder) : folder_(std::move(folder)) {
    const fs::path file = folder_ / kIdentityName;
    if (!fs::exists(file))
        throw InputError(
            folder_.string(),
            fmt::format("has no {}: it is no folder that `stipple decode --part` wrote",
                        kIdentityName));
    const nlohmann::ordered_json json = read_json(file);
    try {
        identity_ = identity_of(json, file);
    } catch (const nlohmann::json::exception&) {
        throw InputError(file.string(), "has a number out of range; decode again");
    }
    const std::string other = difference(json, json_of(identity_));
    if (!other.empty())
        throw InputError(folder_.string(),
                         fmt::format("is of another version of this program: {}", other));
}

std::int64_t WindowFolder::count() const {
    return block_count(identity_.slots);
}

fs::path WindowFolder::window(std::int64_t number) const {
    return folder_ / fmt::format("window_{:06d}.npy", number);
}

std::int64_t WindowFolder::begin_slot(std::int64_t number) const {
    return block_begin(number);
}

std::int64_t WindowFolder::end_slot(std::int64_t number) const {
    return number + 1 < count() ? block_begin(number + 1) : identity_.slots;
}

bool WindowFolder::holds(std::int64_t number) const {
    const fs::path file = window(number);
    if (!fs::exists(file)) return false;
    try {
        const NpyReader reader(file);
        return reader.shape() == identity_.shape &&
               reader.slots() == end_slot(number) - begin_slot(number);
    } catch (const InputError&) {
        return false;  // as after a power cut with --no-sync
    }
}

std::vector<std::int64_t> WindowFolder::missing(std::int64_t begin, std::int64_t end) const {
    std::vector<std::int64_t> numbers;
    for (std::int64_t number = begin; number < end; ++number)
        if (!holds(number)) numbers.push_back(number);
    return numbers;
}

void WindowFolder::remove_leftovers(std::int64_t number) const {
    const fs::path name = window(number).filename();
    std::error_code error;
    for (const PartialOutput& partial : partial_outputs(folder_))
        if (partial.final_path.filename() == name && !partial.running())
            fs::remove(partial.path, error);
}

}  // namespace stipple
