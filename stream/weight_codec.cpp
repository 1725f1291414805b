#include "stream/header_codec.h"

#include <fmt/format.h>

#include <string>
#include <utility>

#include "core/error.h"
#include "core/index.h"
#include "stream/little_endian.h"

namespace stipple {

std::size_t weight_bytes(const ExposureSchedule& schedule) {
    return sizeof(float) * index(schedule.period_slots()) * index(schedule.tile_rows()) *
           index(schedule.tile_cols());
}

std::vector<std::uint8_t> encode_weights(const ExposureSchedule& schedule, std::string_view where) {
    if (schedule.weights().size() > kMaxWeights)
        throw InputError(std::string(where).append(": weights"),
                         "are more than 2^26; use a smaller tile or period");
    std::vector<std::uint8_t> bytes;
    bytes.reserve(weight_bytes(schedule));
    for (const float weight : schedule.weights()) append(bytes, weight);
    return bytes;
}

void decode_weights(std::span<const std::uint8_t> section, std::size_t offset,
                    std::string_view where, ExposureSchedule& schedule) {
    const auto fail = [&](std::string_view problem) {
        throw InputError(fmt::format("{}: byte {}", where, offset), problem);
    };
    if (section.size() > sizeof(float) * kMaxWeights) fail("more than 2^26 weights");
    std::vector<float> weights;
    weights.reserve(section.size() / sizeof(float));
    for (std::size_t at = 0; at < section.size(); at += sizeof(float))
        weights.push_back(load<float>(&section[at]));
    try {
        schedule.set_weights(std::move(weights));
    } catch (const InputError& error) {
        fail(error.what());
    }
    if (!schedule.weighted()) fail("weights section says nothing: all weights are 1");
}

}  // namespace stipple
