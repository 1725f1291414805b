#include "apps/output/stage_outputs.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>
#include <utility>

#include "apps/standard_streams.h"
#include "core/error.h"
#include "io/disk_sync.h"
#include "io/text_file.h"
#include "study/report/chart.h"

namespace stipple {

StageOutputs::StageOutputs(std::filesystem::path folder, FrameShape shape, bool force)
    : folder_(std::move(folder)), shape_(shape), force_(force) {
    if (folder_.empty()) return;
    std::error_code error;
    std::filesystem::create_directories(folder_, error);
    if (error) throw InputError(folder_.string(), "cannot be made: " + error.message());
    sync_to_disk(folder_ / "..");
    refuse_links(folder_);
    chart_.emplace(folder_ / "convergence.png", force_);
}

StageSink StageOutputs::sink() {
    StageSink sink{.frame = {}, .step = [this](const StageStep& step) { add(step); }};
    if (!folder_.empty())
        sink.frame = [this](std::string_view stage, std::int64_t slot,
                            std::span<const float> frame) { write(stage, slot, frame); };
    return sink;
}

void StageOutputs::add(const StageStep& step) {
    if (step.iteration == 0)
        descents_.push_back({step.first_slot, step.tile, std::string(step.stage), {}});
    descents_.back().objective.push_back(step.objective);
}

void StageOutputs::write(std::string_view stage, std::int64_t slot, std::span<const float> frame) {
    StageFile& file = files_[std::string(stage)];
    if (!file.writer)
        file.writer =
            std::make_unique<FrameWriter>((folder_ / fmt::format("{}.npy", stage)).string(), shape_,
                                          FrameWriterOptions{.force = force_});
    const std::vector<float> dark(slot > file.slots ? frame.size() : 0);
    for (; file.slots < slot; ++file.slots) file.writer->write(dark);  // a gap of the recording
    file.writer->write(frame);
    ++file.slots;
}

void StageOutputs::finish() {
    for (auto& [stage, file] : files_) file.writer->finish();
    if (folder_.empty() || descents_.empty()) return;
    try {
        write_text(*chart_, chart());
    } catch (const NoGnuplot& e) {
        say_warning("{} is not drawn: {}", chart_->final_path().string(), e.what());
    }
}

std::string StageOutputs::chart() const {
    std::set<std::string> stages;
    for (const Descent& descent : descents_) stages.insert(descent.stage);
    std::string text =
        fmt::format("set multiplot layout 1,{}\nset grid\nunset key\n", stages.size());
    for (const std::string& stage : stages) {
        std::string data, plots;
        int lines = 0;
        for (const Descent& descent : descents_) {
            if (descent.stage != stage) continue;
            data += fmt::format("${}_{} << END\n", stage, lines);
            for (std::size_t i = 0; i < descent.objective.size(); ++i)
                data += fmt::format("{} {:.9g}\n", i + 1, descent.objective[i]);
            data += "END\n";
            plots += fmt::format("{} ${}_{} with linespoints pointsize 0.5",
                                 lines == 0 ? "plot" : ",", stage, lines);
            ++lines;
        }
        text += fmt::format(
            "{}set title '{}, {} block(s)'\nset xlabel 'iteration'\n"
            "set ylabel 'objective (Eq. 4)'\n{}\n",
            data, stage, lines, plots);
    }
    return draw_chart(".png", {}, text + "unset multiplot\n");
}

nlohmann::ordered_json StageOutputs::figures() const {
    auto json = nlohmann::ordered_json::array();
    for (const Descent& descent : descents_)
        json.push_back({{"first_slot", descent.first_slot},
                        {"tile", descent.tile},
                        {"stage", descent.stage},
                        {"objective", descent.objective}});
    return json;
}

}  // namespace stipple
