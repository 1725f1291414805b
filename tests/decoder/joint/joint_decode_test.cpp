// Streams of several sensors, decoded to one video.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/index.h"
#include "core/parallel.h"
#include "decoder/decode_options.h"
#include "decoder/measurements.h"
#include "decoder/reconstruct.h"
#include "readout/light_warp.h"
#include "stream/stream_writer.h"
#include "tests/decoder/recordings.h"
#include "tests/support/expect_quality.h"
#include "tests/support/temporary_folder.h"

namespace stipple {
namespace {

constexpr FrameShape kShape{.rows = 40, .cols = 56, .planes = 1};
constexpr int kSlots = 24;

/// A camera that delivers each slot.
ExposureSchedule every_slot() {
    return {1, 1, 1, {0, 1}, {Exposure{0, 1}}};
}

/// A disc crosses a wall; a lamp in the lower right corner is 60 times as bright as the wall.
FluxVideo scene(int slots = kSlots, FrameShape shape = kShape) {
    FluxVideo video(slots, shape);
    for (int slot = 0; slot < slots; ++slot)
        for (int row = 0; row < shape.rows; ++row)
            for (int col = 0; col < shape.cols; ++col) {
                const double disc = std::hypot(row - 16, col - 10 - slot);
                const double lamp = std::hypot(row - 30, col - 45);
                const double wall = 0.1 + 0.05 * ((row / 5 + col / 5) % 2);
                video.plane(slot, 0)(row, col) = static_cast<float>(lamp < 5   ? 6 + 0.5 * (col % 3)
                                                                    : disc < 7 ? 0.5
                                                                               : wall);
            }
    return video;
}

/// A sensor of a rig for the test.
struct TestSensor {
    ExposureSchedule schedule;
    double share = 1;
    SensorView view = {};
};

class JointDecodeTest : public testing::Test {
  protected:
    /// Emulates a sensor; its seed is the number of its stream.
    void add(const FluxVideo& video, const TestSensor& sensor) {
        LightWarp warp(sensor.view.from_reference, video.shape());
        FluxVideo seen(video.slots() - static_cast<int>(sensor.view.phase_slots), video.shape());
        for (int slot = 0; slot < seen.slots(); ++slot) {
            const auto frame = warp(video.frame(slot + static_cast<int>(sensor.view.phase_slots)));
            std::ranges::copy(frame, seen.frame(slot).begin());
        }
        SensorParams params;
        params.photons_per_unit *= sensor.share;
        const Recorded recorded = record(seen, sensor.schedule, params, files_.size() + 1);
        files_.push_back(folder_ / (std::to_string(files_.size()) + ".stipple"));
        StreamWriter writer(files_.back(), recorded.header);
        for (const SamplePacket& packet : recorded.packets) writer.write(packet);
        writer.finish();
        views_.push_back(sensor.view);
    }
    FluxVideo decode(DecodeMethod method) {
        std::deque<StreamReader> readers;
        std::vector<RigStream> rig;
        for (std::size_t i = 0; i < files_.size(); ++i)
            rig.push_back({readers.emplace_back(files_[i]), views_[i]});
        std::vector<float> x;
        report_ =
            decode_rig(rig, {.method = method}, [&](std::int64_t, std::span<const float> frame) {
                x.insert(x.end(), frame.begin(), frame.end());
                return true;
            });
        const FrameShape shape = decoded_shape(readers.front().header());
        FluxVideo video(static_cast<int>(report_.slots), shape);
        std::ranges::copy(x, video.data().begin());
        return video;
    }
    FluxVideo decode(const FluxVideo& video, const std::vector<TestSensor>& sensors,
                     DecodeMethod method) {
        files_.clear();
        views_.clear();
        for (const TestSensor& sensor : sensors) add(video, sensor);
        return decode(method);
    }

    TemporaryFolder folder_;
    std::vector<std::filesystem::path> files_;
    std::vector<SensorView> views_;
    DecodeReport report_;  ///< of the last rig
};

/// PSNR of the voxels that `of` selects by light, row and column, without the first and last 4
/// slots.
template <typename Of>
double psnr_db(const FluxVideo& x, const FluxVideo& truth, double peak, const Of& of) {
    double sum = 0;
    std::size_t count = 0;
    for (std::size_t i = 4 * kShape.sites(); i < truth.voxels() - 4 * kShape.sites(); ++i) {
        const auto pixel = static_cast<int>(i % kShape.pixels());
        if (!of(truth.data()[i], pixel / kShape.cols, pixel % kShape.cols)) continue;
        const double error = static_cast<double>(x.data()[i] - truth.data()[i]);
        sum += error * error;
        ++count;
    }
    return 10 * std::log10(peak * peak * static_cast<double>(count) / sum);
}

bool is_lamp(float light, int /*row*/, int /*col*/) {
    return light > 3;
}
/// The wall below the disc and left of the lamp.
bool is_wall(float /*light*/, int row, int col) {
    return row >= 26 && col < 36;
}
/// Where the disc passes.
bool is_path(float /*light*/, int row, int /*col*/) {
    return row >= 9 && row < 24;
}

ExposureSchedule random_of(std::uint64_t seed) {
    return random_schedule(kShape.rows, kShape.cols, kPaperExposureSlots, seed);
}

TEST_F(JointDecodeTest, OneSensorHasTheBitsOfItsStream) {
    const FluxVideo video = scene(70);  // two blocks
    add(video, {random_of(1)});
    for (const DecodeMethod method : {DecodeMethod::kNaive, DecodeMethod::kFast}) {
        StreamReader reader(files_[0]);
        std::vector<float> alone;
        stipple::decode(reader, method, [&](std::int64_t, std::span<const float> frame) {
            alone.insert(alone.end(), frame.begin(), frame.end());
            return true;
        });
        EXPECT_TRUE(std::ranges::equal(decode(method).data(), alone));
    }
}

TEST_F(JointDecodeTest, TwoHalvesOfTheLightHaveTheNoiseOfAll) {
    // Shot noise is that of all the light; of the read noise there is twice as much. At light 0.1,
    // with exposures of n slots, the variances are 100 n + 100 and 100 n + 200: at most 1.8 dB.
    const FluxVideo video = scene();
    const ExposureSchedule schedule = random_of(1);
    struct Case {
        DecodeMethod method;
        double beside_one_db;  // measured, as all below
        double beside_half_db;
    };
    for (const auto& [method, beside_one_db, beside_half_db] :
         {Case{DecodeMethod::kNaive, -1.69, 2.84}, Case{DecodeMethod::kFast, -0.77, 1.05}}) {
        const std::string name(named(method).name);
        const double one = psnr_db(decode(video, {{schedule}}, method), video, 1, is_wall);
        const double half = psnr_db(decode(video, {{schedule, 0.5}}, method), video, 1, is_wall);
        const double two =
            psnr_db(decode(video, {{schedule, 0.5}, {schedule, 0.5}}, method), video, 1, is_wall);
        EXPECT_NEAR(two, one, 1.8) << name;
        expect_quality(name + "_beside_one", two - one, beside_one_db);
        expect_quality(name + "_beside_half", two - half, beside_half_db);
    }
}

TEST_F(JointDecodeTest, SharesReachTheRangeOfAll) {
    // Full scale is 2 units at share 1, 26 at share 0.075: the lamp has 6 to 7.
    const FluxVideo video = scene();
    const TestSensor bright{every_slot(), 0.92}, dim{every_slot(), 0.075};
    struct Case {
        DecodeMethod method;
        double lamp_beside_bright_db;
        double lamp_beside_dim_db;
        double wall_beside_bright_db;
        double wall_beside_dim_db;
    };
    for (const Case& measured : {Case{DecodeMethod::kNaive, 22.76, 0.38, 0.08, 17.76},
                                 Case{DecodeMethod::kFast, 22.02, 3.12, 0.06, 9.15}}) {
        const DecodeMethod method = measured.method;
        const std::string name(named(method).name);
        const FluxVideo of_bright = decode(video, {bright}, method);
        const FluxVideo of_dim = decode(video, {dim}, method);
        const FluxVideo of_both = decode(video, {bright, dim}, method);
        const double lamp = psnr_db(of_both, video, 7, is_lamp);
        const double wall = psnr_db(of_both, video, 1, is_wall);
        expect_quality(name + "_lamp_beside_bright", lamp - psnr_db(of_bright, video, 7, is_lamp),
                       measured.lamp_beside_bright_db);
        expect_quality(name + "_wall_beside_dim", wall - psnr_db(of_dim, video, 1, is_wall),
                       measured.wall_beside_dim_db);
        // Not worse than the better one.
        expect_quality(name + "_lamp_beside_dim", lamp - psnr_db(of_dim, video, 7, is_lamp),
                       measured.lamp_beside_dim_db);
        expect_quality(name + "_wall_beside_bright", wall - psnr_db(of_bright, video, 1, is_wall),
                       measured.wall_beside_bright_db);
    }
}

TEST_F(JointDecodeTest, OtherSchedulesAddWhatTheyKnow) {
    const FluxVideo video = scene();
    // Twice the photons are 3 dB where noise prevails; the prior of fast has removed most of it.
    for (const auto& [method, measured_db] :
         {std::pair{DecodeMethod::kNaive, 2.01}, std::pair{DecodeMethod::kFast, 0.42},
          std::pair{DecodeMethod::kBest, 3.69}}) {
        const double one = psnr_db(decode(video, {{random_of(1), 0.5}}, method), video, 1, is_wall);
        const double two = psnr_db(
            decode(video, {{random_of(1), 0.5}, {random_of(2), 0.5}}, method), video, 1, is_wall);
        expect_quality(std::string(named(method).name), two - one, measured_db);
    }
}

TEST_F(JointDecodeTest, OffsetAndPhaseAreUndone) {
    const FluxVideo video = scene();
    const SensorView moved{Homography::shift({.row = -6, .col = 9}), 3};
    struct Case {
        DecodeMethod method;
        double beside_still_db;
        double beside_here_db;  // the view of the first sensor
        double beside_now_db;   // without the phase
    };
    for (const auto& [method, beside_still_db, beside_here_db, beside_now_db] :
         {Case{DecodeMethod::kNaive, 0.11, 7.44, 2.37},
          Case{DecodeMethod::kFast, -0.76, 23.28, 12.89}}) {
        const std::string name(named(method).name);
        const TestSensor first{random_of(1), 0.5}, second{random_of(2), 0.5};
        TestSensor there = second;
        there.view = moved;
        const double still = psnr_db(decode(video, {first, second}, method), video, 1, is_path);
        const double undone = psnr_db(decode(video, {first, there}, method), video, 1, is_path);
        // A quarter of the pixels has one sensor, and the first slots: about 1 dB.
        EXPECT_NEAR(undone, still, 1) << name;
        expect_quality(name + "_beside_still", undone - still, beside_still_db);
        // Decoded as if it were not moved, it contradicts the first one.
        views_[1] = {};
        expect_quality(name + "_beside_here", undone - psnr_db(decode(method), video, 1, is_path),
                       beside_here_db);
        views_[1] = {moved.from_reference, 0};
        expect_quality(name + "_beside_now", undone - psnr_db(decode(method), video, 1, is_path),
                       beside_now_db);
    }
}

// Of sensors without a full well below full scale, DN 255 is what saturates.
TEST_F(JointDecodeTest, ReportsTheSamplesOfAllSensors) {
    FluxVideo video = scene(70);  // two blocks
    for (int slot = 0; slot < 70; ++slot)
        std::ranges::fill(video.frame(slot).first(4 * 56), 0.0F);  // four rows
    const TestSensor bright{every_slot(), 0.92}, coded{random_of(1), 0.5};
    const TestSensor dim{every_slot(), 0.075, {{}, 3}};
    for (const auto& rig : {std::vector{bright, coded, dim}, {coded, dim, bright}, {coded}}) {
        decode(video, rig, DecodeMethod::kNaive);
        std::uint64_t samples = 0, saturated = 0, zeros = 0;
        for (const auto& file : files_) {
            StreamReader reader(file);
            for (SamplePacket packet; reader.next(packet);) {
                samples += packet.dn.size();
                saturated += static_cast<std::uint64_t>(std::ranges::count(packet.dn, 255));
                zeros += static_cast<std::uint64_t>(std::ranges::count(packet.dn, 0));
            }
        }
        EXPECT_GT(saturated, 0U);
        EXPECT_GT(zeros, 0U);
        EXPECT_EQ(report_.samples, samples);
        EXPECT_EQ(report_.saturated_samples, saturated);
        EXPECT_EQ(report_.zero_samples, zeros);
    }
}

TEST_F(JointDecodeTest, HasTheSameBitsForAnyThreadCount) {
    const FluxVideo video = scene();
    for (const DecodeMethod method : {DecodeMethod::kNaive, DecodeMethod::kFast}) {
        const FluxVideo x =
            decode(video, {{random_of(1), 0.5}, {random_of(2), 0.5, {{}, 1}}}, method);
        const ThreadLimit limit(1);
        const FluxVideo one = decode(method);
        EXPECT_TRUE(std::ranges::equal(x.data(), one.data()));
    }
}

TEST_F(JointDecodeTest, RefusesStreamsThatDoNotBelongTogether) {
    const FluxVideo video = scene();
    const auto problem = [&](DecodeMethod method = DecodeMethod::kNaive) {
        return message_of<InputError>([&] { return decode(method); });
    };
    add(video, {random_of(1)});
    add(video, {random_of(2)});
    expect_parts(problem(DecodeMethod::kPortz2013), {"0.stipple", "2 sensors", "portz2013"});
    expect_parts(problem(DecodeMethod::kLive), {"2 sensors, but method live decodes one"});
    views_[1] = {Homography::shift({.row = 40, .col = 0}), 0};
    expect_parts(problem(), {"1.stipple", "sees no pixel"});
    views_[1] = {Homography({0, 0, 0, 0, 0, 0, 0, 0, 1}), 0};
    expect_parts(problem(), {"1.stipple", "sees no pixel"});
    views_[1] = {{}, 24};
    expect_parts(problem(), {"1.stipple", "begins at slot 24", "24 slots"});
    views_[1] = {};
    views_[0] = {{}, 1};
    expect_parts(problem(), {"0.stipple", "not moved"});
    views_[0] = {};
    files_.pop_back();
    views_.pop_back();
    add(scene(kSlots, {.rows = 40, .cols = 30, .planes = 1}), {every_slot()});
    expect_parts(problem(), {"1.stipple", "30 x 40 x 1", "56 x 40 x 1"});
}

}  // namespace
}  // namespace stipple
