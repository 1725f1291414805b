#include "apps/piece_folder.h"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>
#include <utility>

#include "core/error.h"
#include "core/version.h"
#include "stream/buffered_reader.h"
#include "stream/header_codec.h"
#include "stream/packet_codec.h"

namespace stipple {
namespace fs = std::filesystem;
namespace {

constexpr std::int64_t kMaxSlots = std::int64_t{1} << 53U;  // of a stream

nlohmann::ordered_json json_of(const std::string& provenance, std::uint32_t header_crc,
                               std::int64_t slots) {
    auto lines = nlohmann::ordered_json::array();
    std::istringstream text(provenance);
    for (std::string line; std::getline(text, line);) lines.push_back(line);
    return {{"version", version()},
            {"provenance", lines},
            {"header_crc", header_crc},
            {"piece_slots", kPieceSlots},
            {"slots", slots}};
}

/// The slots that the identity of an emulation tells. \throws InputError if its numbers cannot be.
std::int64_t slots_of(const nlohmann::ordered_json& json, const fs::path& folder) {
    const nlohmann::ordered_json& slots = json["slots"];
    const bool whole = slots.is_number_integer() && json["header_crc"].is_number_unsigned();
    if (!whole || slots < 1 || slots > kMaxSlots)
        throw InputError((folder / kEmulationFolder.identity).string(),
                         "has a number that no stream has; emulate again");
    return slots;
}

std::uint32_t crc_of(const StreamHeader& header) {
    return framing_of(encode_header(header, "sensor")).seed;
}

}  // namespace

PieceFolder::PieceFolder(fs::path folder, const StreamHeader& header,
                         const std::function<std::int64_t()>& count_slots)
    : folder_(std::move(folder)), header_crc_(crc_of(header)) {
    const auto pattern = json_of({}, 0, 0);
    slots_ = is_piece_folder(folder_)
                 ? slots_of(read_identity(folder_, kEmulationFolder, pattern), folder_)
                 : count_slots();
    claim_folder(folder_, kEmulationFolder, json_of(header.provenance, header_crc_, slots_));
}

PieceFolder::PieceFolder(fs::path folder) : folder_(std::move(folder)) {
    const auto pattern = json_of({}, 0, 0);
    const auto json = read_identity(folder_, kEmulationFolder, pattern);
    if (json["version"] != pattern["version"] || json["piece_slots"] != pattern["piece_slots"])
        throw InputError(folder_.string(),
                         fmt::format("is of another version of this program: {} there and {} here",
                                     json["version"].dump(), pattern["version"].dump()));
    slots_ = slots_of(json, folder_);
    header_crc_ = json["header_crc"];
}

std::int64_t PieceFolder::begin_slot(std::int64_t number) const {
    return number * kPieceSlots;
}

std::int64_t PieceFolder::end_slot(std::int64_t number) const {
    return std::min((number + 1) * kPieceSlots, slots_);
}

fs::path PieceFolder::piece(std::int64_t number) const {
    return folder_ / fmt::format("piece_{:06d}.stipple", number);
}

NumberedParts PieceFolder::pieces() const {
    return {(slots_ + kPieceSlots - 1) / kPieceSlots,
            [this](std::int64_t number) { return piece(number); },
            [this](std::int64_t number) { return holds(number); }};
}

/// Whether the piece is there, and has the header of the emulation and an end.
bool PieceFolder::holds(std::int64_t number) const {
    const fs::path file = piece(number);
    if (!fs::exists(file)) return false;
    try {
        BufferedReader window(file);
        const std::size_t bytes = header_bytes(window.peek(kHeaderStartBytes), file.string());
        const auto header = window.peek(bytes);
        if (header.size() < bytes) return false;
        const Framing framing = framing_of(header);
        const std::size_t marker_bytes = end_marker_bytes(framing);
        const std::uint64_t end = window.file_bytes().value_or(0);
        if (framing.seed != header_crc_ || end < bytes + marker_bytes) return false;
        const auto marker = window.read_at(end - marker_bytes, marker_bytes);
        return marker && start_of(*marker, framing) == Start::kEnd;
    } catch (const InputError&) {
        return false;  // as after a power cut with --no-sync
    }
}

bool is_piece_folder(const fs::path& folder) {
    return fs::exists(folder / kEmulationFolder.identity);
}

}  // namespace stipple
