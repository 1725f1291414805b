#include "stream/header_codec.h"

#include <fmt/format.h>

#include <limits>
#include <numeric>
#include <optional>
#include <string>

#include "core/error.h"
#include "stream/crc32c.h"
#include "stream/little_endian.h"

namespace stipple {
namespace {

constexpr std::size_t kMaxTilePixels = std::size_t{1} << 24U;

/// What makes a tile too large to be read safely (docs/stream_format.md), if anything.
std::optional<std::string> tile_fault(std::size_t rows, std::size_t cols, std::size_t period) {
    for (const std::size_t size : {rows, cols, period})
        if (size < 1 || size > 65535)
            return fmt::format("tile of {} x {} pixels, period {} slots: outside 1..65535", rows,
                               cols, period);
    if (rows * cols * period > std::size_t{1} << 32U || rows * period > std::size_t{1} << 24U)
        return fmt::format(
            "tile of {} x {} pixels, period {} slots: more than 2^32 pixel slots "
            "or 2^24 row slots",
            rows, cols, period);
    return std::nullopt;
}

std::optional<std::string> generator_fault(std::span<const int> lengths, FrameShape shape) {
    if (lengths.empty() || lengths.size() > 255 ||
        shape.pixels() * lengths.size() > kMaxRandomExposures)
        return fmt::format("{} x {} pixels with {} exposures each: not 1..255, or more than 2^25",
                           shape.rows, shape.cols, lengths.size());
    for (const int length : lengths)
        if (length < 1 || length > kMaxExposureSlots)
            return fmt::format("exposure of {} slots is outside 1..64", length);
    const int period = std::accumulate(lengths.begin(), lengths.end(), 0);
    return tile_fault(static_cast<std::size_t>(shape.rows), static_cast<std::size_t>(shape.cols),
                      static_cast<std::size_t>(period));
}

void append_tile_size(std::vector<std::uint8_t>& bytes, int rows, int cols, int period_slots) {
    for (const int size : {rows, cols, period_slots})
        append(bytes, static_cast<std::uint16_t>(size));
}

void append_tile_size(std::vector<std::uint8_t>& bytes, const ExposureSchedule& schedule) {
    append_tile_size(bytes, schedule.tile_rows(), schedule.tile_cols(), schedule.period_slots());
}

void append_exposures(std::vector<std::uint8_t>& bytes, std::span<const Exposure> of_pixel) {
    append_varint(bytes, of_pixel.size());
    for (const Exposure& exposure : of_pixel) {
        append_varint(bytes, exposure.first_slot);
        append_varint(bytes, exposure.open_slots);
    }
}

void append_tile_row(std::vector<std::uint8_t>& bytes, const ExposureSchedule& schedule, int row) {
    for (int col = 0; col < schedule.tile_cols(); ++col)
        append_exposures(bytes, schedule.exposures(row, col));
}

std::vector<std::uint8_t> encode_explicit(const ExposureSchedule& schedule) {
    std::vector<std::uint8_t> bytes;
    append_tile_size(bytes, schedule);
    for (int row = 0; row < schedule.tile_rows(); ++row) append_tile_row(bytes, schedule, row);
    return bytes;
}

std::vector<std::uint8_t> encode_random(const ScheduleSource& source) {
    std::vector<std::uint8_t> bytes;
    append(bytes, source.seed);
    append(bytes, static_cast<std::uint8_t>(source.exposure_slots.size()));
    for (const int length : source.exposure_slots) append(bytes, static_cast<std::uint8_t>(length));
    return bytes;
}

std::size_t count_exposures(const ExposureSchedule& schedule) {
    std::size_t count = 0;
    for (int row = 0; row < schedule.tile_rows(); ++row)
        for (int col = 0; col < schedule.tile_cols(); ++col)
            count += schedule.exposures(row, col).size();
    return count;
}

void append_pixel(ByteCursor& cursor, std::size_t period, std::vector<Exposure>& exposures) {
    const std::uint64_t count = cursor.take_varint();
    if (count > period || exposures.size() + count > kMaxTileExposures)
        cursor.fail("more exposures of a pixel than slots, or more than 2^24 in all");
    for (std::uint64_t i = 0; i < count; ++i) {
        const std::uint64_t first_slot = cursor.take_varint();
        if (first_slot >= period) cursor.fail("an exposure begins beyond the period");
        if (i > 0 && first_slot <= exposures.back().first_slot)
            cursor.fail("exposures of a pixel are not in rising order");
        exposures.push_back({static_cast<std::uint32_t>(first_slot), cursor.take_varint()});
    }
}

ExposureSchedule decode_explicit(ByteCursor& cursor) {
    const std::size_t rows = cursor.take<std::uint16_t>();
    const std::size_t cols = cursor.take<std::uint16_t>();
    const std::size_t period = cursor.take<std::uint16_t>();
    if (const auto fault = tile_fault(rows, cols, period)) cursor.fail(*fault);
    // Each pixel takes a byte or more: no memory for pixels that the file does not have.
    if (rows * cols > kMaxTilePixels || rows * cols > cursor.left())
        cursor.fail(fmt::format("tile of {} x {} pixels: more than 2^24, or than the section holds",
                                rows, cols));
    std::vector<std::uint32_t> first{0};
    std::vector<Exposure> exposures;
    for (std::size_t pixel = 0; pixel < rows * cols; ++pixel) {
        append_pixel(cursor, period, exposures);
        first.push_back(static_cast<std::uint32_t>(exposures.size()));
    }
    try {
        return {static_cast<int>(rows), static_cast<int>(cols), static_cast<int>(period),
                std::move(first), std::move(exposures)};
    } catch (const InputError& error) {
        cursor.fail(error.what());
    }
}

ScheduleSource decode_random(ByteCursor& cursor, FrameShape shape) {
    ScheduleSource source{ScheduleSource::Kind::kRandom, {}, cursor.take<std::uint64_t>()};
    const int count = cursor.take<std::uint8_t>();
    for (int i = 0; i < count; ++i) source.exposure_slots.push_back(cursor.take<std::uint8_t>());
    if (const auto fault = generator_fault(source.exposure_slots, shape)) cursor.fail(*fault);
    return source;
}

/// Goes over a random schedule row by row, in the memory of a row.
StoredSchedule count_random(const ScheduleSource& source, FrameShape shape,
                            std::optional<DueCounts>& counts) {
    RandomExposures random(source.exposure_slots, source.seed);
    const auto first = random.of(0);
    const auto count = static_cast<std::uint32_t>(first.size());
    StoredSchedule stored{{1, 1, random.period_slots(), {0, count}, {first.begin(), first.end()}},
                          source};
    counts.emplace(shape.rows, random.period_slots());
    std::vector<std::uint8_t> bytes;
    append_tile_size(bytes, shape.rows, shape.cols, random.period_slots());
    std::uint32_t pixel = 0;
    for (int row = 0; row < shape.rows; ++row) {
        for (int col = 0; col < shape.cols; ++col) {
            const auto of_pixel = random.of(pixel++);
            append_exposures(bytes, of_pixel);
            counts->add(row, of_pixel);
        }
        stored.crc = crc32c(bytes, stored.crc);
        bytes.clear();
    }
    return stored;
}

StoredSchedule make_random(const ScheduleSource& source, FrameShape shape, std::string_view where,
                           const ScheduleUse& use) {
    if (use.counts != nullptr) return count_random(source, shape, *use.counts);
    check_memory(random_schedule_bytes(shape.rows, shape.cols, source.exposure_slots), where,
                 "its schedule", use.input_bytes);
    StoredSchedule stored{
        random_schedule(shape.rows, shape.cols, source.exposure_slots, source.seed), source};
    stored.crc = schedule_crc(stored.schedule);
    return stored;
}

}  // namespace

std::vector<std::uint8_t> encode_schedule(const ExposureSchedule& schedule,
                                          const ScheduleSource& source, FrameShape shape,
                                          std::string_view where) {
    const auto fail = [&](std::string_view problem) {
        throw InputError(std::string(where).append(": schedule"), problem);
    };
    if (source.kind == ScheduleSource::Kind::kRandom) {
        if (const auto fault = generator_fault(source.exposure_slots, shape)) fail(*fault);
        // Found out now rather than when the recording is read.
        std::optional<DueCounts> counts;
        if (schedule_crc(schedule) != count_random(source, shape, counts).crc)
            fail("is not what the generator of its source makes");
        return encode_random(source);
    }
    const auto rows = static_cast<std::size_t>(schedule.tile_rows());
    const auto cols = static_cast<std::size_t>(schedule.tile_cols());
    const auto period = static_cast<std::size_t>(schedule.period_slots());
    if (const auto fault = tile_fault(rows, cols, period)) fail(*fault);
    if (rows * cols > kMaxTilePixels || count_exposures(schedule) > kMaxTileExposures)
        fail("has more than 2^24 pixels or exposures in its tile; use a smaller tile");
    return encode_explicit(schedule);
}

StoredSchedule decode_schedule(const ScheduleSection& section, FrameShape shape,
                               std::string_view where, const ScheduleUse& use) {
    ByteCursor cursor(section.bytes, section.offset, where);
    const auto reject_rest = [&] {
        if (cursor.left() > 0) cursor.fail("bytes are left over after the schedule");
    };
    if (section.kind == ScheduleSource::Kind::kRandom) {
        const ScheduleSource source = decode_random(cursor, shape);
        reject_rest();
        return make_random(source, shape, where, use);
    }
    StoredSchedule stored{decode_explicit(cursor), {}};
    reject_rest();
    stored.crc = schedule_crc(stored.schedule);
    return stored;
}

std::uint32_t schedule_crc(const ExposureSchedule& schedule) {
    std::vector<std::uint8_t> bytes;
    append_tile_size(bytes, schedule);
    std::uint32_t crc = crc32c(bytes);
    for (int row = 0; row < schedule.tile_rows(); ++row) {
        bytes.clear();
        append_tile_row(bytes, schedule, row);
        crc = crc32c(bytes, crc);
    }
    return crc;
}

}  // namespace stipple
