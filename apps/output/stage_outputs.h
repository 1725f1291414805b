#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/geometry.h"
#include "decoder/stage_observer.h"
#include "io/frame_writer.h"
#include "io/pending_output.h"

namespace stipple {

/// Keeps the results of the stages of a decoding method: their frames as NAME.npy in a folder, and
/// the descent of their objective as figures and as a chart (convergence.png) in that folder.
class StageOutputs {
  public:
    /// `folder` is created if it does not exist; empty: no files, figures only. \throws InputError
    /// if it cannot be made, or as PendingOutput for the chart.
    StageOutputs(std::filesystem::path folder, FrameShape shape, bool force);

    /// For DecodeOptions; refers to this object. Its frames throw as FrameWriter.
    [[nodiscard]] StageSink sink();

    /// Completes the files; without gnuplot there is no chart but a warning. \throws as FrameWriter
    /// and draw_chart.
    void finish();

    /// For each block and stage {first_slot, tile, stage, objective: one per iteration}.
    [[nodiscard]] nlohmann::ordered_json figures() const;

  private:
    /// The iterations of a stage on a block.
    struct Descent {
        std::int64_t first_slot = 0;
        int tile = 0;
        std::string stage;
        std::vector<double> objective;
    };
    struct StageFile {
        std::unique_ptr<FrameWriter> writer;
        std::int64_t slots = 0;
    };

    void add(const StageStep& step);
    void write(std::string_view stage, std::int64_t slot, std::span<const float> frame);
    [[nodiscard]] std::string chart() const;

    std::filesystem::path folder_;
    FrameShape shape_;
    bool force_;
    std::optional<PendingOutput> chart_;
    std::vector<Descent> descents_;
    std::map<std::string, StageFile, std::less<>> files_;
};

}  // namespace stipple
