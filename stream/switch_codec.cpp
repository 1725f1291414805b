#include <string>

#include "core/error.h"
#include "stream/header_codec.h"
#include "stream/little_endian.h"
#include "stream/schedule_switch.h"

namespace stipple {

std::vector<std::uint8_t> encode_switch(const ScheduleSwitch& next, FrameShape shape,
                                        std::string_view where) {
    auto fault = readout_fault(next.values);
    if (!fault) fault = name_fault(next.name);
    if (fault) throw InputError(where, *fault);
    const auto section = encode_schedule(next.schedule, next.source, shape, where);
    std::vector<std::uint8_t> bytes;
    for (const double value :
         {next.values.black_level_dn, next.values.gain_e_per_dn, next.values.read_noise_e,
          next.values.full_well_e, next.values.electrons_per_unit})
        append(bytes, value);
    append(bytes, static_cast<std::uint8_t>(next.values.rounding));
    append(bytes, static_cast<std::uint8_t>(next.source.kind));
    append(bytes, static_cast<std::uint16_t>(next.name.size()));
    append(bytes, schedule_crc(next.schedule));
    bytes.insert(bytes.end(), next.name.begin(), next.name.end());
    bytes.insert(bytes.end(), section.begin(), section.end());
    return bytes;
}

ScheduleSwitch decode_switch(std::span<const std::uint8_t> payload, FrameShape shape,
                             std::string_view where, const ScheduleUse& use) {
    ByteCursor cursor(payload, 0, where);
    ReadoutValues values;
    for (double* const value : {&values.black_level_dn, &values.gain_e_per_dn, &values.read_noise_e,
                                &values.full_well_e, &values.electrons_per_unit})
        *value = cursor.take<double>();
    values.rounding = static_cast<Rounding>(cursor.take<std::uint8_t>());
    if (const auto fault = readout_fault(values)) cursor.fail(*fault);
    const auto kind = cursor.take<std::uint8_t>();
    if (kind > 1) cursor.fail("unknown schedule kind");
    const std::size_t name_bytes = cursor.take<std::uint16_t>();
    const auto crc = cursor.take<std::uint32_t>();
    if (name_bytes >= cursor.left()) cursor.fail("the name exceeds the packet");
    const std::size_t name_at = payload.size() - cursor.left();
    const auto* const text = reinterpret_cast<const char*>(&payload[name_at]);
    std::string name(text, name_bytes);
    if (const auto fault = name_fault(name)) cursor.fail(*fault);
    const std::size_t section_at = name_at + name_bytes;
    StoredSchedule stored = decode_schedule(
        {ScheduleSource::Kind{kind}, payload.subspan(section_at), section_at}, shape, where, use);
    if (stored.crc != crc) cursor.fail("the schedule is not the one that was recorded");
    return {.slot = 0,
            .schedule = std::move(stored.schedule),
            .source = std::move(stored.source),
            .name = std::move(name),
            .values = values};
}

}  // namespace stipple
