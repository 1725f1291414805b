#include "session/measurement_export.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/error.h"
#include "core/index.h"
#include "io/npz_volume.h"
#include "readout/schedules/tiled_schedule.h"
#include "tests/decoder/recordings.h"
#include "tests/stream/stream_bytes.h"
#include "tests/support/temporary_folder.h"

namespace stipple {
namespace {

constexpr FrameShape kShape{.rows = 4, .cols = 6, .planes = 1};
constexpr int kSlots = 20;

/// Pixels of a period of 5 slots in turn: open in slots 0 and 2, in slot 4, never.
ExposureSchedule periodic() {
    return {1, 3, 5, {0, 1, 2, 2}, {{0, 0b101}, {4, 1}}};
}

class MeasurementExportTest : public testing::Test {
  protected:
    StreamReader reader(const ExposureSchedule& schedule) {
        const Recorded recorded = record(video_, schedule, rounding_sensor());
        write_text(folder_ / "a.stipple", bytes_of(recorded.header, recorded.packets).bytes);
        return StreamReader(folder_ / "a.stipple");
    }
    static MeasurementExport exported(StreamReader stream, const ExportOptions& options) {
        return *export_measurements(stream, options, [](double) { return true; });
    }
    std::string problem(const ExposureSchedule& schedule, const ExportOptions& options) {
        return message_of<InputError>([&] { return exported(reader(schedule), options); });
    }
    static const std::vector<float>& meas(const MeasurementExport& result) {
        return std::get<std::vector<float>>(result.arrays[1].values);
    }
    static const std::vector<std::uint8_t>& mask(const MeasurementExport& result) {
        return std::get<std::vector<std::uint8_t>>(result.arrays[0].values);
    }

    TemporaryFolder folder_;
    FluxVideo video_ = random_video(kSlots, kShape, 1);
};

// A DN is 5 / 65535 of light.
constexpr double kHalfDn = 0.51 * 5 / 65535;

TEST_F(MeasurementExportTest, SharedMasksAddUpTheLight) {
    const MeasurementExport result = exported(reader(periodic()), {});
    EXPECT_EQ(result.measurements, 4);
    EXPECT_EQ(result.slots, 5);
    EXPECT_EQ(result.samples, 4U * 4 * 4);
    for (int m = 0; m < 4; ++m)
        for (int row = 0; row < kShape.rows; ++row)
            for (int col = 0; col < kShape.cols; ++col) {
                double sum = 0;
                for (int t = 0; t < 5; ++t)
                    sum += mask(result)[index(t) * 24 + row_major(row, col, 6)] *
                           static_cast<double>(video_.frame(5 * m + t)[row_major(row, col, 6)]);
                EXPECT_NEAR(meas(result)[index(m) * 24 + row_major(row, col, 6)], sum, kHalfDn);
                EXPECT_EQ(sum > 0, col % 3 < 2);
            }
}

TEST_F(MeasurementExportTest, OwnMasksAddUpTheLight) {
    constexpr int kLengths[] = {1, 2};
    const ExposureSchedule schedule = tiled_schedule(2, 3, kLengths, 1);
    const MeasurementExport result =
        exported(reader(schedule), {.masks = ExportMasks::kOwn, .slots = {.begin = 2, .end = 19}});
    EXPECT_EQ(result.slots, 17);
    for (int k = 0; k < result.measurements; ++k)
        for (std::size_t pixel = 0; pixel < 24; ++pixel) {
            double sum = 0;
            for (int t = 0; t < 17; ++t)
                sum += mask(result)[(index(k) * 17 + index(t)) * 24 + pixel] *
                       static_cast<double>(video_.frame(t + 2)[pixel]);
            EXPECT_NEAR(meas(result)[index(k) * 24 + pixel], sum, kHalfDn);
        }
}

TEST_F(MeasurementExportTest, SaysWhyMasksAreNotShared) {
    expect_parts(problem({1, 1, 4, {0, 2}, {{0, 1}, {2, 1}}}, {}),
                 {"a.stipple: pixel (0, 0) has 2 exposures in a period of 4 slots", "masks"});
    expect_parts(problem({1, 1, 4, {0, 1}, {{3, 0b11}}}, {}),
                 {"pixel (0, 0) has an exposure that goes on in the next period of 4 slots"});
    expect_parts(problem(periodic(), {.slots = {.begin = 1}}), {"slots", "period", "5 slots"});
    expect_parts(problem(periodic(), {.slots = {.begin = 0, .end = 25}}),
                 {"holds 20 slots, not 25"});
}

TEST_F(MeasurementExportTest, IsWrittenAsTheNameSays) {
    const MeasurementExport result = exported(reader(periodic()), {});
    for (const char* name : {"a.npz", "a.mat"}) {
        PendingOutput output(folder_ / name, false);
        write_export(result, output);
    }
    EXPECT_EQ(read_npz_volume(folder_ / "a.npz", "meas").at(3, 2, 1),
              static_cast<double>(meas(result)[3 * 24 + row_major(2, 1, 6)]));
    EXPECT_EQ(read_text(folder_ / "a.mat").substr(0, 6), "MATLAB");
}

TEST_F(MeasurementExportTest, StopsIfAsked) {
    StreamReader stream = reader(periodic());
    EXPECT_FALSE(export_measurements(stream, {}, [](double) { return false; }));
}

}  // namespace
}  // namespace stipple
