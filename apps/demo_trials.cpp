#include "apps/demo_trials.h"

#include <fmt/format.h>

#include <array>
#include <cstddef>

#include "apps/output/side_by_side.h"
#include "io/frame_writer.h"

namespace stipple {
namespace fs = std::filesystem;
namespace {

/// A way to record and decode the scene.
struct Trial {
    const char* name;
    const char* schedule;
    DecodeMethod method;
    const char* text;  ///< description
};
constexpr std::array<Trial, 5> kTrials = {
    {{"4x exposure", "full4x", DecodeMethod::kNaive,
      "a conventional camera that exposes 4 slots together, its frames held"},
     {"1x exposure", "full1x", DecodeMethod::kNaive,
      "a conventional camera that exposes 1 slot in 4, its frames interpolated in time"},
     {"1x, decoded", "full1x", DecodeMethod::kFast,
      "the same frames, denoised and interpolated along motion by the method fast"},
     {"coded, naive", "random", DecodeMethod::kNaive,
      "coded exposures, each pixel by its own nearest samples"},
     {"coded, decoded", "random", DecodeMethod::kFast, "the same samples by the method fast"}}};

/// A slot that is shown side by side.
struct ShownSlot {
    int slot;
    SideBySide versions;
};

std::vector<ShownSlot> shown_slots(const FluxVideo& truth) {
    std::vector<std::string> names;
    names.reserve(kTrials.size() + 1);
    for (const Trial& trial : kTrials) names.emplace_back(trial.name);
    names.emplace_back("truth");
    std::vector<ShownSlot> shown;
    for (const int quarter : {1, 2, 3}) {
        const int slot = truth.slots() * quarter / 4;
        shown.push_back({slot, SideBySide(truth.shape(), names)});
        shown.back().versions.put(kTrials.size(), truth.frame(slot));
    }
    return shown;
}

}  // namespace

std::vector<TrialResult> run_trials(const FluxVideo& truth, const fs::path& folder,
                                    RunReport& report, const RunOptions& run) {
    std::vector<ShownSlot> shown = shown_slots(truth);
    FrameWriter frames(folder / "decoded", truth.shape(), {.force = run.force});
    FrameWriter video(folder / "decoded.mp4", truth.shape(), {.force = run.force});
    std::vector<TrialResult> results;
    std::size_t reported_run = 0;
    for (std::size_t i = 0; i < kTrials.size(); ++i) {
        const auto& [name, schedule, method, text] = kTrials[i];
        const fs::path file = folder / fmt::format("{}.stipple", schedule);
        const bool emulated = i > 0 && results.back().schedule == schedule;
        const StreamSize size =
            emulated ? results.back().size : emulate_video(truth, schedule, file, run);
        if (!emulated) reported_run = report.add_run(file, schedule);
        const std::size_t reported = report.add_video({name, text, reported_run});
        const auto take = [&](std::int64_t slot, std::span<const float> frame) {
            report.put(reported, slot, frame);
            for (ShownSlot& where : shown)
                if (where.slot == slot) where.versions.put(i, frame);
            if (i + 1 < kTrials.size()) return true;
            frames.write(frame);
            video.write(frame);
            return true;
        };
        results.push_back(
            {name, schedule, text, size, decode_and_compare(file, method, truth, take, run)});
    }
    frames.finish();
    video.finish();
    for (std::size_t i = 0; i < shown.size(); ++i)
        shown[i].versions.write(folder / fmt::format("side_by_side_{}.png", i + 1), run.force);
    return results;
}

}  // namespace stipple
