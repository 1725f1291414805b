#include <array>
#include <nlohmann/json.hpp>
#include <string_view>

#include "capture/recording/recording_format.h"
#include "core/error.h"

namespace stipple {
namespace {

using Json = nlohmann::ordered_json;
using ReadJson = nlohmann::json;  // which finds a key among very many
using Texts = std::map<std::string, std::string>;

/// By GapCause: the names in a recording (docs/recording_format.md). Reports say `queue_drop` where
/// version 1 of the format says `own_drop`.
constexpr std::array<std::string_view, kGapCauses.size()> kStoredCauses{
    "none", "device", "transport", "host_underrun", "own_drop", "reconnect", "layout"};

std::string dumped(const Json& json) {
    return json.dump(1, ' ', false, Json::error_handler_t::replace);
}

Json json_of(const CameraDescription& camera) {
    std::vector<std::string> warnings;
    for (const Message& warning : camera.warnings) warnings.push_back(warning.text());
    return {{"transport", camera.transport},
            {"address", camera.address},
            {"vendor", camera.vendor},
            {"model", camera.model},
            {"serial", camera.serial},
            {"firmware", camera.firmware},
            {"genicam_xml_hash", camera.genicam_xml_hash},
            {"features", camera.features},
            {"transport_facts", camera.transport_facts},
            {"warnings", warnings}};
}

CameraDescription camera_of(const ReadJson& json) {
    const auto warnings = json.at("warnings").get<std::vector<std::string>>();
    return {.transport = json.at("transport"),
            .address = json.at("address"),
            .vendor = json.at("vendor"),
            .model = json.at("model"),
            .serial = json.at("serial"),
            .firmware = json.at("firmware"),
            .genicam_xml_hash = json.at("genicam_xml_hash"),
            .features = json.at("features").get<Texts>(),
            .transport_facts = json.at("transport_facts").get<Texts>(),
            .warnings = {warnings.begin(), warnings.end()}};
}

Json json_of(const ClockFit& fit) {
    return {{"epoch", fit.epoch},         {"frames", fit.frames},
            {"origin_ns", fit.origin_ns}, {"offset_ns", fit.offset_ns},
            {"drift_ppm", fit.drift_ppm}, {"spread_ns", fit.spread_ns}};
}

ClockFit fit_of(const ReadJson& json) {
    return {.epoch = json.at("epoch"),
            .frames = json.at("frames"),
            .origin_ns = json.at("origin_ns"),
            .offset_ns = json.at("offset_ns"),
            .drift_ppm = json.at("drift_ppm"),
            .spread_ns = json.at("spread_ns")};
}

/// What `read` makes of the JSON `text`.
template <typename Read>
auto parsed(std::string_view text, std::string_view where, Read read) {
    try {
        return read(ReadJson::parse(text));
    } catch (const ReadJson::exception& e) {
        throw InputError(where, std::string("is not the JSON of a recording: ").append(e.what()));
    }
}

}  // namespace

std::string encode_session(const SessionRecord& session) {
    Json fields = Json::array();
    for (const RecordField& field : frame_record_fields())
        fields.push_back({field.name, field.type});
    Json settings = Json::array();
    for (const auto& [name, value] : session.settings) settings.push_back({name, value});
    return dumped({{"frame_record", fields},
                   {"causes", kStoredCauses},
                   {"camera", json_of(session.camera)},
                   {"settings", settings},
                   {"host", session.host},
                   {"started_realtime_ns", session.started_realtime_ns}});
}

SessionRecord decode_session(std::string_view text, std::string_view where) {
    return parsed(text, where, [](const ReadJson& json) {
        return SessionRecord{.camera = camera_of(json.at("camera")),
                             .settings = json.at("settings").get<CameraSettings>(),
                             .host = json.at("host").get<Texts>(),
                             .started_realtime_ns = json.at("started_realtime_ns")};
    });
}

std::string encode_end(const RecordingEnd& end) {
    Json lost = Json::object();
    for (std::size_t i = 1; i < kStoredCauses.size(); ++i)
        lost[std::string(kStoredCauses[i])] = end.lost[i];
    Json clocks = Json::array();
    for (const ClockFit& fit : end.clocks) clocks.push_back(json_of(fit));
    return dumped({{"reason", end.reason},
                   {"frames", end.frames},
                   {"incomplete", end.incomplete},
                   {"payload_bytes", end.payload_bytes},
                   {"lost", lost},
                   {"transport",
                    {{"underruns", end.transport.underruns},
                     {"packets_resent", end.transport.packets_resent},
                     {"packets_missing", end.transport.packets_missing},
                     {"socket_drops", end.transport.socket_drops},
                     {"link_faults", end.transport.link_faults},
                     {"size_mismatches", end.transport.size_mismatches}}},
                   {"clocks", clocks}});
}

RecordingEnd decode_end(std::string_view text, std::string_view where) {
    return parsed(text, where, [](const ReadJson& json) {
        RecordingEnd end{.reason = json.at("reason"),
                         .frames = json.at("frames"),
                         .incomplete = json.at("incomplete"),
                         .payload_bytes = json.at("payload_bytes")};
        for (std::size_t i = 1; i < kStoredCauses.size(); ++i)
            // Earlier versions of this program know fewer causes.
            end.lost[i] = json.at("lost").value(std::string(kStoredCauses[i]), std::uint64_t{0});
        const ReadJson& transport = json.at("transport");
        end.transport = {.underruns = transport.at("underruns"),
                         .packets_resent = transport.at("packets_resent"),
                         .packets_missing = transport.at("packets_missing"),
                         .socket_drops = transport.at("socket_drops"),
                         .link_faults = transport.at("link_faults"),
                         .size_mismatches = transport.at("size_mismatches")};
        for (const ReadJson& fit : json.at("clocks")) end.clocks.push_back(fit_of(fit));
        return end;
    });
}

}  // namespace stipple
