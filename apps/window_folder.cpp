#include "apps/window_folder.h"

#include <fmt/format.h>

#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <utility>

#include "core/error.h"
#include "core/version.h"
#include "decoder/block_partition.h"
#include "io/npy_header.h"
#include "io/npy_reader.h"
#include "stream/stream_identity.h"

namespace stipple {
namespace fs = std::filesystem;
namespace {

constexpr std::int64_t kMaxSlots = std::int64_t{1} << 53U;  // of a stream
constexpr int kMaxSide = 65535;

nlohmann::ordered_json json_of(const WindowIdentity& identity) {
    return {{"version", version()},
            {"stream_bytes", identity.stream_bytes},
            {"stream", identity.stream},
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

WindowIdentity identity_of(const nlohmann::ordered_json& json, const fs::path& file) {
    WindowIdentity identity{
        .stream_bytes = json["stream_bytes"],
        .stream = json["stream"],
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

}  // namespace

WindowFolder::WindowFolder(fs::path folder, const WindowIdentity& identity)
    : folder_(std::move(folder)), identity_(identity) {
    if (has_identity(folder_, kDecodingFolder, json_of(identity)))
        decoding_ = identity_text(folder_, kDecodingFolder);
}

WindowFolder::WindowFolder(fs::path folder) : folder_(std::move(folder)) {
    const nlohmann::ordered_json json = read_identity(folder_, kDecodingFolder, json_of({}));
    const fs::path file = folder_ / kDecodingFolder.identity;
    try {
        identity_ = identity_of(json, file);
    } catch (const nlohmann::json::exception&) {
        throw InputError(file.string(), "has a number out of range; decode again");
    }
    const std::string other = first_difference(json, json_of(identity_));
    if (!other.empty())
        throw InputError(folder_.string(),
                         fmt::format("is of another version of this program: {}", other));
    decoding_ = identity_text(folder_, kDecodingFolder);
}

void WindowFolder::claim() {
    if (decoding_) return;
    claim_folder(folder_, kDecodingFolder, json_of(identity_));
    decoding_ = identity_text(folder_, kDecodingFolder);
}

std::int64_t WindowFolder::count() const {
    return block_count(identity_.slots);
}

fs::path WindowFolder::window(std::int64_t number) const {
    return folder_ / fmt::format("window_{:06d}.npy", number);
}

std::string WindowFolder::mark(std::int64_t number) const {
    return window_mark(number, decoding_.value());
}

std::int64_t WindowFolder::begin_slot(std::int64_t number) const {
    return block_begin(number);
}

std::int64_t WindowFolder::end_slot(std::int64_t number) const {
    return number + 1 < count() ? block_begin(number + 1) : identity_.slots;
}

NumberedParts WindowFolder::windows() const {
    return {count(), [this](std::int64_t number) { return window(number); },
            [this](std::int64_t number) { return holds(number); }};
}

bool WindowFolder::holds(std::int64_t number) const {
    const fs::path file = window(number);
    if (!decoding_ || !fs::exists(file)) return false;
    try {
        const NpyReader reader(file);
    } catch (const InputError&) {
        return false;  // as after a power cut with --no-sync
    }
    const auto slots = static_cast<int>(end_slot(number) - begin_slot(number));
    const std::string header = format_npy_header(slots, identity_.shape, mark(number));
    std::string start(header.size(), 0);
    std::ifstream(file, std::ios::binary).read(start.data(), std::ssize(start));
    if (start != header)
        throw InputError(file.string(),
                         "is not this window of the decoding that decoding.json describes: it was "
                         "copied from elsewhere, or an earlier version wrote it; remove it, and "
                         "run `stipple decode --part` again");
    return true;
}

}  // namespace stipple
