#include "stream/header_codec.h"

#include <gtest/gtest.h>

#include "core/error.h"
#include "stream/crc32c.h"
#include "stream/due_count.h"
#include "tests/stream/stream_files.h"
#include "tests/support/temporary_folder.h"

namespace stipple {
namespace {

using Bytes = std::vector<std::uint8_t>;
using Kind = ScheduleSource::Kind;

constexpr FrameShape kShape{4, 6, 1};

StoredSchedule decode(Kind kind, const Bytes& section) {
    return decode_schedule({kind, section, 100}, kShape, "a");
}

void expect_refused(Kind kind, const Bytes& section, const std::string& problem) {
    expect_parts(message_of<InputError>([&] { return decode(kind, section); }),
                 {"a: byte 1", problem});
}

/// A section of one pixel with period 9.
Bytes one_pixel(const Bytes& exposures) {
    Bytes section{1, 0, 1, 0, 9, 0};
    for (const std::uint8_t byte : exposures) section.push_back(byte);
    return section;
}

TEST(ScheduleCodecTest, AnExplicitScheduleIsItsListOfExposures) {
    const ExposureSchedule schedule(1, 2, 300, {0, 1, 3}, {{299, 0b11}, {0, 1}, {130, 0x81}});
    const StreamHeader header{kShape, 5000, {}, schedule, {}, "", ""};
    const Bytes section{1, 0,    2,    0,    0x2C, 0x01,         // 1 x 2 pixels, 300 slots
                        1, 0xAB, 0x02, 3,                        // 299 = 0x12B
                        2, 0,    1,    0x82, 0x01, 0x81, 0x01};  // 130 and 0x81: two bytes each
    EXPECT_EQ(encode_schedule(header, ""), section);
    EXPECT_EQ(decode(Kind::kExplicit, section).schedule, schedule);
    EXPECT_EQ(schedule_crc(schedule), crc32c(section));
}

TEST(ScheduleCodecTest, ARandomScheduleIsItsSeedAndLengths) {
    const StreamHeader header = random_header(kShape, 0x0102030405060708U);
    const Bytes section{8, 7, 6, 5, 4, 3, 2, 1, 4, 1, 2, 4, 8};
    EXPECT_EQ(encode_schedule(header, ""), section);
    const StoredSchedule stored = decode(Kind::kRandom, section);
    EXPECT_EQ(stored.schedule, header.schedule);
    EXPECT_EQ(stored.source, header.schedule_source);
}

TEST(ScheduleCodecTest, ASourceThatMakesAnotherScheduleIsRefused) {
    StreamHeader header = random_header(kShape, 1);
    header.schedule_source.seed = 2;
    expect_parts(message_of<InputError>([&] { return encode_schedule(header, "a"); }),
                 {"a: schedule: is not what the generator of its source makes"});
}

TEST(ScheduleCodecTest, TilesBeyondTheLimitsAreRefused) {
    expect_refused(Kind::kExplicit, {0, 0, 1, 0, 1, 0, 0}, "tile of 0 x 1 pixels");
    expect_refused(Kind::kExplicit, {1, 0, 1, 0, 0, 0, 0}, "period 0 slots");
    expect_refused(Kind::kExplicit, {0, 2, 1, 0, 0, 0x80, 0}, "");  // fits: ends too early
    expect_refused(Kind::kExplicit, {1, 2, 1, 0, 0, 0x80, 0}, "2^24 row slots");
    expect_refused(Kind::kExplicit, {1, 0, 0xFF, 0xFF, 1, 0, 0}, "than the section holds");
}

TEST(ScheduleCodecTest, ExposuresThatBreakARuleAreRefused) {
    EXPECT_NO_THROW(decode(Kind::kExplicit, one_pixel({2, 1, 3, 3, 1})));
    expect_refused(Kind::kExplicit, one_pixel({1, 9, 1}), "begins beyond the period");
    expect_refused(Kind::kExplicit, one_pixel({2, 3, 1, 1, 1}), "not in rising order");
    expect_refused(Kind::kExplicit, one_pixel({2, 1, 1, 1, 1}), "not in rising order");
    expect_refused(Kind::kExplicit, one_pixel({1, 0, 2}), "closed in its first slot");
    expect_refused(Kind::kExplicit, one_pixel({1, 0, 0xFF, 0x07}), "exceeds the period");
    expect_refused(Kind::kExplicit, one_pixel({2, 1, 3, 2, 1}), "share this slot");
    expect_refused(Kind::kExplicit, one_pixel({10}), "more exposures of a pixel than slots");
}

TEST(ScheduleCodecTest, NumbersThatAreCutOrTooLongAreRefused) {
    expect_refused(Kind::kExplicit, {}, "ends too early");
    expect_refused(Kind::kExplicit, one_pixel({1, 0}), "ends too early");
    expect_refused(Kind::kExplicit, one_pixel({1, 0, 0x81}), "ends too early");
    expect_refused(Kind::kExplicit, one_pixel({0x81, 0}), "not in its shortest form");
    expect_refused(Kind::kExplicit,
                   one_pixel({1, 0, 0x81, 0x80, 0x80, 0x80, 0x80, 0x80, 0x80, 0x80, 0x80, 2}),
                   "exceeds 64 bits");
    expect_refused(Kind::kExplicit, one_pixel({0, 0}), "left over");
    expect_refused(Kind::kRandom, {1, 2, 3, 4, 5, 6, 7, 8, 1}, "ends too early");
    expect_refused(Kind::kRandom, {1, 2, 3, 4, 5, 6, 7, 8, 1, 5, 0}, "left over");
}

TEST(ScheduleCodecTest, GeneratorsBeyondTheLimitsAreRefused) {
    expect_refused(Kind::kRandom, {1, 2, 3, 4, 5, 6, 7, 8, 0}, "not 1..255");
    expect_refused(Kind::kRandom, {1, 2, 3, 4, 5, 6, 7, 8, 1, 0}, "outside 1..64");
    expect_refused(Kind::kRandom, {1, 2, 3, 4, 5, 6, 7, 8, 1, 65}, "outside 1..64");
    const Bytes section{1, 2, 3, 4, 5, 6, 7, 8, 2, 1, 1};
    expect_parts(message_of<InputError>([&] {
                     return decode_schedule({Kind::kRandom, section, 100}, {65535, 257, 1}, "a");
                 }),
                 {"more than 2^25"});
}

TEST(ScheduleCodecTest, SamplesAreCountedByTilesAsByPixels) {
    for (const StreamHeader& header : {varied_header({7, 8, 3}), random_header({7, 8, 1}, 5)})
        for (const std::int64_t slot : {0, 1, 2, 5, 63, 64, 65, 70, 1000000007})
            for (int row = 0; row < 7; ++row)
                for (int rows = 1; row + rows <= 7; ++rows) {
                    const std::size_t samples = count_due(header.schedule, slot, row, rows, 8) *
                                                static_cast<std::size_t>(header.shape.planes);
                    EXPECT_TRUE(matches_schedule(header, slot, {row, rows}, samples));
                    EXPECT_FALSE(matches_schedule(header, slot, {row, rows}, samples + 1));
                    if (samples == 0) continue;
                    EXPECT_FALSE(matches_schedule(header, slot, {row, rows}, samples - 1));
                }
}

TEST(ScheduleCodecTest, ARandomScheduleIsCountedWithoutBeingKept) {
    constexpr FrameShape kArray{7, 8, 1};
    for (const std::vector<int>& lengths :
         std::vector<std::vector<int>>{{1, 2, 4, 8}, {64, 3}, {1}}) {
        const ScheduleSource source{Kind::kRandom, lengths, 3};
        const ExposureSchedule schedule = random_schedule(7, 8, lengths, 3);
        const StreamHeader header{kArray, 5000, {}, schedule, source, "", ""};
        const Bytes section = encode_schedule(header, "");
        std::optional<DueCounts> counts;
        const auto stored = decode_schedule({Kind::kRandom, section, 100}, kArray, "a", {&counts});
        EXPECT_EQ(stored.crc, schedule_crc(schedule));
        EXPECT_EQ(stored.source, source);
        EXPECT_EQ(stored.schedule.period_slots(), schedule.period_slots());
        EXPECT_EQ(stored.schedule.samples_per_pixel_slot(), schedule.samples_per_pixel_slot());
        EXPECT_EQ(stored.schedule.light_throughput(), schedule.light_throughput());
        for (std::int64_t slot = 0; slot < 200; ++slot)
            for (int row = 0; row < 7; ++row)
                EXPECT_EQ(counts->due(slot, row), count_due(schedule, slot, row, 1, 8));
        EXPECT_TRUE(matches_counts(*counts, 9, {1, 5}, 3, 3 * count_due(schedule, 9, 1, 5, 8)));
    }
}

}  // namespace
}  // namespace stipple
