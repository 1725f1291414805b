#include "study/explore/trial_store.h"

#include <fmt/format.h>
#include <openssl/evp.h>

#include <array>
#include <cmath>
#include <fstream>
#include <iterator>
#include <limits>
#include <new>
#include <nlohmann/json.hpp>
#include <span>
#include <system_error>
#include <utility>

#include "core/error.h"
#include "core/version.h"
#include "io/disk_sync.h"
#include "io/partial_output.h"
#include "io/pending_output.h"
#include "io/text_file.h"

namespace stipple {
namespace fs = std::filesystem;
namespace {

using nlohmann::ordered_json;

constexpr const char* kInfinite = "inf";  // JSON has no number for it

/// Empty if the file cannot be read.
std::string text_of(const fs::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

void write_managed(const fs::path& file, std::string_view text) {
    PendingOutput output(file, true, OutputKind::kManagedFile);
    write_text(output, text);
}

ordered_json json_of(const TrialFigures& figures) {
    ordered_json json;
    for (const TextColumn& column : kTextColumns)
        json[std::string(column.name)] = figures.*column.value;
    for (const FigureColumn& column : kFigureColumns) {
        const double value = figures.*column.value;
        json[std::string(column.name)] =
            std::isinf(value) ? ordered_json(kInfinite) : ordered_json(value);  // NaN becomes null
    }
    return json;
}

/// Nothing if a figure is of another type.
std::optional<TrialFigures> figures_of(const ordered_json& json) {
    TrialFigures figures;
    if (!json.is_object()) return std::nullopt;
    for (const TextColumn& column : kTextColumns) {
        const auto found = json.find(column.name);
        if (found == json.end() || !found->is_string()) return std::nullopt;
        figures.*column.value = found->get<std::string>();
    }
    for (const FigureColumn& column : kFigureColumns) {
        const auto found = json.find(column.name);
        if (found == json.end()) return std::nullopt;
        if (found->is_number())
            figures.*column.value = found->get<double>();
        else if (*found == kInfinite)
            figures.*column.value = std::numeric_limits<double>::infinity();
        else if (!found->is_null())
            return std::nullopt;
    }
    return figures;
}

/// \throws InputError if something else than an empty folder has the name, DeviceError if that
/// cannot be told.
void check_free(const fs::path& folder) {
    std::error_code error;
    const fs::file_status status = fs::status(folder, error);
    if (status.type() == fs::file_type::not_found) return;
    bool is_free = fs::is_directory(status);
    if (is_free) is_free = fs::is_empty(folder, error);
    if (error) throw DeviceError(folder.string(), "cannot be read: " + error.message());
    if (!is_free)
        throw InputError(folder.string(), "is not a folder of results; give another name");
}

/// Makes the folder unless there is one. \throws InputError if there is no folder to make it in,
/// DeviceError if it cannot be made.
void make_folder(const fs::path& folder) {
    std::error_code error;
    if (fs::create_directory(folder, error)) sync_to_disk(folder / "..");
    if (error == std::errc::no_such_file_or_directory || error == std::errc::not_a_directory)
        throw InputError(folder.string(),
                         "there is no folder that it could be made in; create that first");
    if (error) throw DeviceError(folder.string(), "cannot be made: " + error.message());
}

}  // namespace

TrialStore::TrialStore(fs::path folder) : folder_(std::move(folder)) {
    const fs::path version_file = folder_ / "version.txt";
    const std::string own = std::string(version()) + "\n";
    std::error_code error;
    refuse_links(folder_);
    if (fs::exists(version_file, error)) {
        if (text_of(version_file) != own)
            throw InputError(folder_.string(),
                             fmt::format("holds results of another version of this program, not of "
                                         "{}; give another name, or remove it",
                                         version()));
    } else {
        check_free(folder_);
        make_folder(folder_);
        write_managed(version_file, own);
    }
    make_folder(folder_ / "trials");
    refuse_links(folder_ / "trials");
    for (const PartialOutput& partial : partial_outputs(folder_ / "trials"))
        if (!partial.running()) fs::remove(partial.path, error);  // of a killed run
}

std::optional<TrialFigures> TrialStore::find(const std::string& identity) const {
    const auto json =
        ordered_json::parse(text_of(path(address_of(identity), ".json")), nullptr, false);
    if (!json.is_object() || !json.contains("figures") ||
        json.value("identity", ordered_json()) != identity)
        return std::nullopt;
    return figures_of(json["figures"]);
}

std::string TrialStore::address_of(const std::string& identity) {
    std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
    if (EVP_Digest(identity.data(), identity.size(), digest.data(), nullptr, EVP_sha256(),
                   nullptr) != 1)
        throw std::bad_alloc();
    std::string address;
    for (const unsigned char byte : std::span(digest).first<8>())
        address += fmt::format("{:02x}", byte);
    return address;
}

fs::path TrialStore::path(const std::string& address, std::string_view extension) const {
    return folder_ / "trials" / (address + std::string(extension));
}

std::vector<std::uint8_t> TrialStore::picture(const std::string& address) const {
    const std::string bytes = text_of(path(address, ".png"));
    return {bytes.begin(), bytes.end()};
}

fs::path TrialStore::stream_of(const std::string& identity) const {
    return path(address_of(identity), ".stipple");
}

void TrialStore::store(const std::string& identity, const TrialOutcome& outcome) const {
    // The figures last: with them the trial counts as known.
    const std::string address = address_of(identity);
    const fs::path picture = path(address, ".png");
    PendingOutput output(picture, true, OutputKind::kManagedFile);
    write_png_file(output.partial(), outcome.picture, picture.string());
    output.commit();
    write_managed(path(address, ".json"),
                  ordered_json{{"identity", identity}, {"figures", json_of(outcome.figures)}}.dump(
                      2, ' ', false, ordered_json::error_handler_t::replace) +
                      "\n");
}

void TrialStore::write(const std::string& name, std::string_view text) const {
    write_managed(folder_ / name, text);
}

}  // namespace stipple
