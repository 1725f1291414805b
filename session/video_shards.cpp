#include "session/video_shards.h"

#include <fmt/format.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <system_error>
#include <utility>

#include "core/error.h"
#include "core/version.h"
#include "decoder/block_partition.h"
#include "decoder/measurements.h"
#include "io/npy_file.h"
#include "io/pending_output.h"
#include "readout/footage_origin.h"
#include "session/decode_session.h"
#include "session/shard_folder.h"
#include "stream/crc32c.h"

namespace stipple {
namespace fs = std::filesystem;
namespace {

constexpr std::int64_t kMaxSlots = std::int64_t{1} << 53U;  // of a stream
constexpr int kMaxSide = 65535;

nlohmann::ordered_json json_of(const DecodingIdentity& identity) {
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

/// \throws nlohmann::json::exception, InputError.
DecodingIdentity from_json(const nlohmann::ordered_json& json, const fs::path& file) {
    DecodingIdentity identity{
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

/// The slots of a stream, by its index or else by its packets.
std::int64_t slots_of(const fs::path& file, const std::function<void()>& check) {
    StreamReader reader(file, ReadPolicy::kCounts);
    reader.follow_switches();
    if (!reader.slots())
        for (SamplePacket packet; reader.next(packet);) check();
    const std::int64_t slots = reader.slots().value_or(reader.report().slots);
    if (slots == 0) throw InputError(file.string(), "holds no slot to decode");
    return slots;
}

}  // namespace

DecodingIdentity identity_of(const ShardedDecoding& decoding, const std::function<void()>& check) {
    const fs::path& stream = decoding.stream;
    const auto sha256_of = [&](const fs::path& file) {
        return origin_of(file.string(), {}, check).sha256;
    };
    const StreamHeader header = StreamReader(stream).header();
    const fs::path calibration = calibration_file(stream, decoding.calibration);
    const DecodeOptions& options = decoding.setup.options;
    const std::string file = option_file(options);
    const auto whole = stream_identity(stream);
    return {.stream_bytes = fs::file_size(stream),
            .stream = whole ? *whole : "sha256 " + sha256_of(stream),
            .method = std::string(named(options.method).name),
            .options = decoding.setup.given + (file.empty() ? "" : "# " + sha256_of(file)),
            .calibration_sha256 = calibration.empty() ? "" : sha256_of(calibration),
            .fill_gaps = options.fill_gaps,
            .slots = slots_of(stream, check),
            .shape = decoded_shape(header),
            .slot_us = header.slot_us};
}

std::string identity_text(const DecodingIdentity& identity) {
    return json_of(identity).dump(2) + "\n";
}

DecodingIdentity parse_identity(const std::string& text, const fs::path& where) {
    const auto json = parsed_identity(text, where, kDecodingFolder, json_of({}));
    DecodingIdentity identity;
    try {
        identity = from_json(json, where);
    } catch (const nlohmann::json::exception&) {
        throw InputError(where.string(), "has a number out of range; decode again");
    }
    const std::string other = first_difference(json, json_of(identity));
    if (!other.empty())
        throw InputError(where.string(),
                         fmt::format("is of another version of this program: {}", other));
    return identity;
}

std::string window_mark(std::int64_t number, std::string_view decoding) {
    const auto* const bytes = reinterpret_cast<const std::uint8_t*>(decoding.data());
    return fmt::format("window {} of {:08x}", number, crc32c({bytes, decoding.size()}));
}

VideoShards::VideoShards(fs::path folder, const DecodingIdentity& identity)
    : folder_(std::move(folder)), identity_(identity) {
    if (has_identity(folder_, kDecodingFolder, json_of(identity)))
        decoding_ = stored_identity(folder_, kDecodingFolder);
}

VideoShards::VideoShards(fs::path folder) : folder_(std::move(folder)) {
    decoding_ = stored_identity(folder_, kDecodingFolder);
    identity_ = parse_identity(*decoding_, folder_ / kDecodingFolder.identity);
}

void VideoShards::claim() {
    if (decoding_) return;
    claim_folder(folder_, kDecodingFolder, json_of(identity_));
    decoding_ = stored_identity(folder_, kDecodingFolder);
}

std::int64_t VideoShards::count() const {
    return block_count(identity_.slots);
}

fs::path VideoShards::window(std::int64_t number) const {
    return folder_ / fmt::format("window_{:06d}.npy", number);
}

std::string VideoShards::mark(std::int64_t number) const {
    return window_mark(number, decoding_.value());
}

std::int64_t VideoShards::begin_slot(std::int64_t number) const {
    return block_begin(number);
}

std::int64_t VideoShards::end_slot(std::int64_t number) const {
    return number + 1 < count() ? block_begin(number + 1) : identity_.slots;
}

NumberedFiles VideoShards::windows() const {
    return {count(), [this](std::int64_t number) { return window(number); },
            [this](std::int64_t number) { return holds(number); }};
}

bool VideoShards::holds(std::int64_t number) const {
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
                         "decode again");
    return true;
}

void VideoShards::require_all() const {
    windows().require_all(folder_, kDecodingFolder);
}

struct VideoShards::Writer::Impl {
    PendingOutput output;
    NpyWriter npy;
    std::int64_t lacking;  ///< frames

    Impl(const VideoShards& folder, std::int64_t number)
        : output(folder.window(number), true, OutputKind::kManagedFile),
          npy(output.partial(), output.final_path().string(), folder.identity().shape,
              folder.mark(number)),
          lacking(folder.end_slot(number) - folder.begin_slot(number)) {}
};

VideoShards::Writer::Writer(const VideoShards& folder, std::int64_t number) {
    remove_leftovers(folder.window(number));
    impl_ = std::make_unique<Impl>(folder, number);
}

VideoShards::Writer::~Writer() = default;
VideoShards::Writer::Writer(Writer&&) noexcept = default;
VideoShards::Writer& VideoShards::Writer::operator=(Writer&&) noexcept = default;

bool VideoShards::Writer::write(std::span<const float> frame) {
    impl_->npy.write(frame);
    if (--impl_->lacking > 0) return false;
    impl_->npy.finish();
    impl_->output.commit();
    return true;
}

std::optional<StreamReport> decode_windows(
    VideoShards& folder, const ShardedDecoding& decoding, const NumberRange& windows,
    const std::function<bool(double slots, std::int64_t frames)>& progress) {
    DecodeSetup setup = decoding.setup;
    setup.options.first_slot = folder.begin_slot(windows.begin);
    DecodeSession session(StreamReader(decoding.stream, decoding.policy), setup,
                          decoding.calibration);
    for (const Message& warning : session.warnings()) decoding.warn(warning);
    session.end_after(folder.end_slot(windows.end - 1));
    std::int64_t frames = 0;
    std::int64_t number = windows.begin;
    bool stopped = false;
    std::optional<VideoShards::Writer> window;
    const auto reach = [&](double slots) {
        stopped = stopped || !progress(slots, frames);
        return !stopped;
    };
    static_cast<void>(session.run(
        [&](std::int64_t, std::span<const float> frame) {
            if (!window) {
                folder.claim();  // only now: the method has accepted the stream
                window.emplace(folder, number);
            }
            ++frames;
            if (!window->write(frame)) return true;
            window.reset();
            ++number;
            return reach(static_cast<double>(frames));
        },
        [&](double slots) {
            return reach(slots - static_cast<double>(setup.options.first_slot));
        }));
    if (number == windows.end) return session.streams().front().report();
    if (stopped) return {};
    throw InputError(decoding.stream.string(), "has changed while it was decoded");
}

}  // namespace stipple
