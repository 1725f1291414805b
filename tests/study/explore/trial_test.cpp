#include "study/explore/trial.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <stdexcept>
#include <string>

#include "core/error.h"
#include "decoder/measurements.h"
#include "decoder/reconstruct.h"
#include "stream/stream_reader.h"
#include "tests/study/explore/dictionary_bytes.h"
#include "tests/support/source_tree.h"
#include "tests/support/temporary_folder.h"

namespace stipple {
namespace {

const std::string kClip = "[clip]\nframes = 16\nrows = 16\ncols = 24\n";

bool keep_going() {
    return true;
}

const std::string kTwo =
    "sensors = ['a', 'b']\na = { share = 0.8, schedule = 'full4x' }\n"
    "b = { share = 0.2, schedule = 'full1x', phase_slots = 4 }\n";

class TrialTest : public testing::Test {
  protected:
    /// The first point of a space of sensor `paper`.
    [[nodiscard]] static Trial trial_of(const std::string& axes, const std::string& set = "") {
        const Space space = space_of(axes, set);
        return set_up_trial(space, space.point(0), light(space), space.frames, {4, 12});
    }
    [[nodiscard]] TrialFigures figures_of(const std::string& axes,
                                          const std::string& set = "") const {
        const Space space = space_of(axes, set);
        return run_trial(trial_of(axes, set), light(space), folder_ / "a.stipple", keep_going)
            .figures;
    }
    /// A file with this text, as TOML writes its name.
    [[nodiscard]] std::string written(const std::string& name, const std::string& text) const {
        write_text(folder_ / name, text);
        return "'" + (folder_ / name).string() + "'\n";
    }

    const TemporaryFolder folder_;

    [[nodiscard]] static Space space_of(const std::string& axes, const std::string& set) {
        return parse_space("[axes]\nsensor = 'paper'\n" + axes + "[set]\n" + set + kClip,
                           "space.toml");
    }
    [[nodiscard]] static TrialLight light(const Space& space) {
        return read_light(space, "pan", {}, keep_going);
    }
    /// The first point with this decoder.
    [[nodiscard]] static Trial trial_of(const OwnDecoder& decoder, const std::string& axes = "",
                                        const std::string& set = "") {
        Space space = space_of(axes, set);
        space.decoders = {decoder};
        space.set_methods({decoder.name});
        return set_up_trial(space, space.point(0), light(space), space.frames, {4, 12});
    }
    [[nodiscard]] TrialFigures figures_of(const OwnDecoder& decoder,
                                          const std::string& axes = "") const {
        return run_trial(trial_of(decoder, axes), light(space_of(axes, "")), folder_ / "a.stipple",
                         keep_going)
            .figures;
    }
};

/// A method of Stipple as an own decoder.
OwnDecoder decoder_by(DecodeMethod method) {
    return {"own", [method](const std::filesystem::path& stream, const std::string&) {
                StreamReader reader(stream);
                FluxVideo video(static_cast<int>(reader.slots().value()),
                                decoded_shape(reader.header()));
                decode(reader, method, [&](std::int64_t slot, std::span<const float> frame) {
                    std::ranges::copy(frame, video.frame(static_cast<int>(slot)).begin());
                    return true;
                });
                return video;
            }};
}

TEST_F(TrialTest, AnOwnDecoderHasTheFiguresOfTheMethodThatItCalls) {
    for (const char* view : {"", "binning = 2\n", "window_rows = 0.5\n"}) {
        const TrialFigures own = figures_of(decoder_by(DecodeMethod::kFast), view);
        const TrialFigures fast = figures_of(std::string("method = 'fast'\n") + view);
        for (const FigureColumn& column : kFigureColumns) {
            if (column.name.starts_with("decode_") || std::isnan(fast.*column.value)) continue;
            EXPECT_EQ(own.*column.value, fast.*column.value) << view << column.name;
        }
        EXPECT_GT(own.decode_seconds, 0);
        EXPECT_EQ(std::isnan(own.decode_megabytes), std::isnan(fast.decode_megabytes));
    }
}

TEST_F(TrialTest, AnOwnDecoderGetsTheOptionsOfThePointAndIsIdentifiedByThemAndItsVersion) {
    const auto identity = [&](const std::string& version, const std::string& set) {
        OwnDecoder own = decoder_by(DecodeMethod::kNaive);
        own.version = version;
        return trial_of(own, "", set).identity;
    };
    const std::string first = identity("1", "'decoder.sigma' = 0.5\n");
    EXPECT_EQ(identity("1", "'decoder.sigma' = 0.5\n"), first);
    EXPECT_NE(identity("2", "'decoder.sigma' = 0.5\n"), first);
    EXPECT_NE(identity("1", "'decoder.sigma' = 0.25\n"), first);
    EXPECT_EQ(trial_of(decoder_by(DecodeMethod::kNaive), "", "'decoder.sigma' = 0.5\n").own_options,
              "sigma = 0.5\n");
}

TEST_F(TrialTest, WhatAnOwnDecoderThrowsLeavesNoStream) {
    const OwnDecoder empty{"own", [](const auto&, const auto&) { return FluxVideo(); }};
    EXPECT_THROW(static_cast<void>(figures_of(empty)), DecoderFault);
    const OwnDecoder failing{
        "own", [](const auto&, const auto&) -> FluxVideo { throw std::domain_error("a reason"); }};
    EXPECT_THROW(static_cast<void>(figures_of(failing)), std::domain_error);
    EXPECT_TRUE(folder_.names().empty());
    EXPECT_THROW(static_cast<void>(trial_of(failing, "rig = " + written("two.toml", kTwo))),
                 InputError);
}

TEST_F(TrialTest, ADictionaryIsIdentifiedByItsBytes) {
    const auto identity = [&](const std::string& file) {
        return trial_of("method = 'hitomi2011'\n", "'decoder.dictionary' = " + file).identity;
    };
    const std::string first = identity(written("a.npy", dictionary_bytes(4)));
    EXPECT_EQ(identity(written("b.npy", dictionary_bytes(4))), first);
    EXPECT_NE(identity(written("a.npy", dictionary_bytes(5))), first);
    EXPECT_EQ(identity(written("a.npy", dictionary_bytes(4))), first);
}

TEST_F(TrialTest, ARigIsIdentifiedByItsContent) {
    const auto identity = [&](const std::string& name, const std::string& text) {
        return trial_of("rig = " + written(name, text)).identity;
    };
    const std::string first = identity("a.toml", kTwo);
    EXPECT_EQ(identity("b.toml", "# the same\n" + kTwo), first);
    for (const char* key :
         {"a.seed = 5\n", "b.offset_px = [0, 1]\n", "a.set = ['sensor.bit_depth=9']\n"}) {
        std::string other = kTwo;
        const std::string table = std::string(1, key[0]) + " = { ";
        const std::string entry(key + 2);
        other.insert(other.find(table) + table.size(), entry.substr(0, entry.size() - 1) + ", ");
        EXPECT_NE(identity("a.toml", other), first) << key;
    }
}

TEST_F(TrialTest, FiguresAreThoseOfTheWholeRig) {
    const TrialFigures both = figures_of("method = 'naive'\nrig = " + written("two.toml", kTwo));
    const TrialFigures a = figures_of("method = 'naive'\nschedule = 'full4x'\n");
    const TrialFigures b = figures_of("method = 'naive'\nschedule = 'full1x'\n");
    EXPECT_DOUBLE_EQ(both.light_throughput, 0.8 * 1 + 0.2 * 0.25);
    EXPECT_EQ(a.samples_per_voxel, 0.25);
    EXPECT_EQ(both.samples_per_voxel, 0.5);
    EXPECT_EQ(both.slots_per_second, 200);  // slots of 5 ms
    EXPECT_DOUBLE_EQ(both.megabits_per_second, a.megabits_per_second + b.megabits_per_second);
    // Brightest in 1 slot of the share 0.2, darkest in 4 slots of the share 0.8.
    EXPECT_NEAR(both.sample_range_stops - a.sample_range_stops, 4,
                1e-12);  // log2(0.8 4 / (0.2 1))
    EXPECT_TRUE(std::isnan(both.energy_uj_per_slot));
    for (const char* stream : {"a.stipple", "a.2.stipple"})
        EXPECT_FALSE(std::filesystem::exists(folder_ / stream)) << stream;
}

TEST_F(TrialTest, RivalsShareOneApertureAndTheSamplesOfFramesOf4Slots) {
    Space space = parse_space(read_text(project_path("config/spaces/rivals.toml")), "rivals.toml");
    write_text(folder_ / "d.npy", dictionary_bytes(4));
    space.replace({"decoder.dictionary", {(folder_ / "d.npy").string()}});
    space.readout_sensor.clear();  // whose schedules of a large array take long
    const TrialLight light{FluxVideo(space.frames, {.rows = 32, .cols = 32}), {}};
    int rigs = 0, bounds = 0;
    for (std::uint64_t number = 0; number < space.size(); ++number) {
        const SpacePoint point = space.point(number);
        const Trial trial = set_up_trial(space, point, light, space.frames, {4, 12});
        double share = 0, samples = 0;
        for (std::size_t i = 0; i < trial.setups.size(); ++i) {
            share += trial.rig.sensors[i].share;
            samples += trial.setups[i].schedule.schedule.samples_per_pixel_slot() *
                       static_cast<double>(trial.setups[i].shape.pixels()) /
                       static_cast<double>(light.video.shape().pixels());
        }
        const std::string& system = space.value(point, "system");
        EXPECT_NEAR(share, 1, 1e-3) << system;  // a splitter loses some light
        const bool is_rig = trial.setups.size() > 1;
        rigs += is_rig ? 1 : 0;
        const bool is_bound = system.find("4 x samples") != std::string::npos;
        bounds += is_bound ? 1 : 0;
        EXPECT_NEAR(samples, is_bound ? 1 : 0.25, is_rig ? 1e-12 : 0.125 * 0.25 + 1e-12) << system;
    }
    EXPECT_EQ(rigs, 4);
    EXPECT_EQ(bounds, 2);
}

/// Light 0.25, but 1.5 in the first and the last quarter of the rows.
TrialLight framed_light() {
    TrialLight light{FluxVideo(12, {16, 24, 1}), {}};
    std::ranges::fill(light.video.data(), 0.25F);
    for (int slot = 0; slot < 12; ++slot)
        for (const int row : {0, 1, 2, 3, 12, 13, 14, 15})
            std::ranges::fill(light.video.plane(slot, 0).row(row), 1.5F);
    return light;
}

TEST_F(TrialTest, ABinnedSensorAndAWindowReadAQuarterOfTheSamples) {
    const TrialLight light = framed_light();
    const auto trial_of_view = [&](const std::string& axes) {
        const Space space =
            parse_space("[axes]\nsensor = 'ideal'\nschedule = 'full1x'\nmethod = 'naive'\n" + axes +
                            "[set]\n'schedule.period_slots' = 1\n[readout]\nsensor = 'lux1310'\n",
                        "space.toml");
        return set_up_trial(space, space.point(0), light, 12, {4, 8});
    };
    const auto figures = [&](const std::string& axes) {
        return run_trial(trial_of_view(axes), light, folder_ / "a.stipple", keep_going).figures;
    };
    const TrialFigures whole = figures("");
    const TrialFigures binned = figures("binning = 2\n");
    const TrialFigures window = figures("window_rows = 0.25\n");
    EXPECT_EQ(whole.samples_per_voxel, 1);
    for (const TrialFigures& part : {binned, window}) {
        EXPECT_EQ(part.samples_per_voxel, 0.25);
        EXPECT_EQ(part.light_throughput, 1);
        EXPECT_NEAR(part.megabits_per_second, whole.megabits_per_second / 4, 1e-9);
        EXPECT_GT(part.readout_slots_per_second, 3 * whole.readout_slots_per_second);
    }
    EXPECT_EQ(binned.field_of_view, 1);
    EXPECT_EQ(window.field_of_view, 0.25);
    // The window is flat. Of the binned frame the edges are not, by far less than they are high.
    EXPECT_GT(window.psnr_db, 80);
    EXPECT_GT(binned.psnr_db, 10);
    EXPECT_LT(binned.psnr_db, 40);
    EXPECT_EQ(window.compared_slots, "4:8");
    const SensorParams params = trial_of_view("binning = 2\n").setups.front().params;
    EXPECT_EQ(params.photons_per_unit, 4000);
    EXPECT_NE(trial_of_view("binning = 2\n").identity, trial_of_view("").identity);
    EXPECT_NE(trial_of_view("window_rows = 0.25\n").identity, trial_of_view("").identity);
    EXPECT_NE(trial_of_view("binning = 2\nbinning_mode = 'voltage'\n").identity,
              trial_of_view("binning = 2\nbinning_mode = 'charge'\n").identity);
}

TEST_F(TrialTest, OnlyTheComparedSlotsCount) {
    TrialLight light = framed_light();
    const Space space = parse_space(
        "[axes]\nsensor = 'ideal'\nschedule = 'full4x'\nmethod = 'naive'\n", "space.toml");
    // A flash in the last frame, which the decoder spreads over 4 slots.
    std::ranges::fill(light.video.frame(9), 1.0F);
    const auto psnr = [&](ComparedSlots compared) {
        const Trial trial = set_up_trial(space, space.point(0), light, 12, compared);
        return run_trial(trial, light, folder_ / "a.stipple", keep_going).figures.psnr_db;
    };
    EXPECT_GT(psnr({0, 8}), 80);
    EXPECT_LT(psnr({0, 9}), 40);
    EXPECT_LT(psnr({11, 12}), 20);
}

TEST_F(TrialTest, CodeHasABitForEachPixelUnlessRowsExposeAlike) {
    const auto code = [&](const std::string& schedule) {
        return figures_of("method = 'naive'\nschedule = '" + schedule + "'\n")
            .code_megabits_per_second;
    };
    EXPECT_DOUBLE_EQ(code("random"), 1e-6 * 16 * 24 * 200);
    for (const char* schedule : {"full1x", "rolling", "coded_rolling_shutter_exposure"})
        EXPECT_EQ(code(schedule), 0) << schedule;
}

TEST_F(TrialTest, OptionsOfReadingAreOfFootageInFiles) {
    const Space space = parse_space("[axes]\nsensor = 'paper'\n", "space.toml");
    FootageOptions reading;
    reading.part.bin = 2;
    expect_parts(
        message_of<InputError>([&] { (void)read_light(space, "pan", reading, keep_going); }),
        {"pan: is an embedded scene", "stipple synth"});
}

TEST_F(TrialTest, TheSlowestReadoutOfARigLimitsItAndEnergiesAdd) {
    const std::string timed = "method = 'naive'\n";
    const std::string set = "'sensor.slot_us' = 1\n";
    const auto figures = [&](const std::string& axes) {
        const Space space =
            parse_space("[axes]\nsensor = 'lux1310'\n" + timed + axes + "[set]\n" + set +
                            "[clip]\nframes = 12\nrows = 32\ncols = 64\n"
                            "[readout]\nrows = 1024\ncols = 1280\n",
                        "space.toml");
        const TrialLight light = read_light(space, "pan", {}, keep_going);
        const Trial trial = set_up_trial(space, space.point(0), light, space.frames, {4, 8});
        return run_trial(trial, light, folder_ / "a.stipple", keep_going).figures;
    };
    const std::string rig =
        written("rig.toml",
                "sensors = ['a', 'b']\na = { share = 0.5, schedule = 'full4x' }\n"
                "b = { share = 0.5, schedule = 'random' }\n");
    const TrialFigures both = figures("rig = " + rig);
    const TrialFigures a = figures("schedule = 'full4x'\n");
    const TrialFigures b = figures("schedule = 'random'\nseed = 2\n");
    EXPECT_NE(a.readout_slots_per_second, b.readout_slots_per_second);
    EXPECT_EQ(both.readout_slots_per_second,
              std::min(a.readout_slots_per_second, b.readout_slots_per_second));
    EXPECT_EQ(both.slots_per_second, std::min(a.slots_per_second, b.slots_per_second));
    EXPECT_DOUBLE_EQ(both.energy_uj_per_slot, a.energy_uj_per_slot + b.energy_uj_per_slot);
}

TEST_F(TrialTest, ASensorThatBeginsAfterTheClipIsNamed) {
    std::string late = kTwo;
    late.replace(late.find("phase_slots = 4"), 15, "phase_slots = 16");
    const std::string axes = "method = 'naive'\nrig = " + written("late.toml", late);
    expect_parts(message_of<InputError>([&] { return figures_of(axes); }),
                 {"sensor \"b\" of the rig", "begins at slot 16", "16 slots"});
    EXPECT_FALSE(std::filesystem::exists(folder_ / "a.stipple"));
}

}  // namespace
}  // namespace stipple
