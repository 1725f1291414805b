#include "session/rig_emulation.h"

#include <fmt/format.h>

#include <cstddef>
#include <string_view>

#include "io/pending_output.h"
#include "io/text_file.h"
#include "readout/footage_origin.h"

namespace stipple {
namespace fs = std::filesystem;
namespace {

bool is_rig_file(std::string_view name) {
    return name == kRigFile || name.ends_with(".stipple");
}

/// The rig as it was read, with what identifies its streams.
std::string rig_text(const Config& config, const Rig& rig, const fs::path& folder,
                     const std::function<void()>& check) {
    std::string text = config.as_toml("");
    for (const RigSensor& sensor : rig.sensors)
        text += fmt::format("{}.sha256 = \"{}\"\n", sensor.name,
                            origin_of(folder / sensor.file(), {}, check).sha256);
    return text;
}

}  // namespace

RigEmulation::RigEmulation(const std::string& rig, const std::vector<std::string>& settings,
                           FrameShape footage, ColourFilter filter)
    : config_(find_config(ConfigKind::kRigs, rig), settings, "rig"),
      rig_(read_rig(config_)),
      setups_(set_up_rig(rig_, footage, filter)) {}

RigEmulation::~RigEmulation() = default;

void RigEmulation::begin(const fs::path& output, bool force, const FootageOrigin& origin) {
    folder_ = std::make_unique<PendingOutput>(output, force, OutputKind::kFolder, is_rig_file);
    for (std::size_t i = 0; i < setups_.size(); ++i)
        recorders_.emplace_back(
            rig_.sensors[i], setups_[i], folder_->partial() / rig_.sensors[i].file(),
            StreamRecorderOptions{.provenance = provenance_of(setups_[i], origin)});
}

void RigEmulation::expose(std::span<const float> frame) {
    for (RigRecorder& recorder : recorders_) recorder.expose(slots_, frame);
    ++slots_;
}

void RigEmulation::finish(const std::function<void()>& check) {
    for (RigRecorder& recorder : recorders_) recorder.finish(slots_);
    write_whole(folder_->partial() / kRigFile, (folder_->final_path() / kRigFile).string(),
                rig_text(config_, rig_, folder_->partial(), check));
    folder_->commit();
}

RigTotals RigEmulation::totals() const {
    RigTotals totals;
    for (const RigRecorder& recorder : recorders_)
        totals.add(recorder.recorder(), recorder.sensor().share);
    return totals;
}

}  // namespace stipple
