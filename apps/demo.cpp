#include <fmt/format.h>

#include <chrono>
#include <nlohmann/json.hpp>
#include <string>

#include "apps/arguments/common_options.h"
#include "apps/arguments/footage.h"
#include "apps/demo_trials.h"
#include "apps/output/json_file.h"
#include "apps/output/own_command.h"
#include "apps/subcommands.h"
#include "core/error.h"
#include "io/disk_sync.h"
#include "io/pending_output.h"
#include "io/text_file.h"
#include "study/explore/trial.h"
#include "study/report/run_report.h"

namespace stipple {
namespace fs = std::filesystem;
namespace {

// Of the pictures in the page, which keep all slots: the whole frame takes five times as much.
constexpr int kPageRows = 108;
constexpr int kPageCols = 144;

struct DemoOptions {
    std::string folder = "stipple_demo";
    std::string scene = "pan";
    SceneOptions rendering;
};

/// The folder of a run that may be stopped before there is anything in it.
class DemoFolder {
  public:
    /// \throws InputError, DeviceError.
    DemoFolder(const fs::path& folder, bool force);
    ~DemoFolder() {
        std::error_code error;
        if (made_) fs::remove(path_, error);  // only if it is empty
    }
    DemoFolder(const DemoFolder&) = delete;
    DemoFolder& operator=(const DemoFolder&) = delete;

    [[nodiscard]] const fs::path& path() const { return path_; }

  private:
    fs::path path_;
    bool made_ = false;
};

DemoFolder::DemoFolder(const fs::path& folder, bool force) : path_(folder) {
    std::error_code error;
    if (fs::is_directory(folder, error) && !fs::is_empty(folder, error) && !force)
        throw InputError(folder.string(),
                         "exists already; give another name, or --force to replace what is in it");
    if (fs::exists(folder, error) && !fs::is_directory(folder, error))
        throw InputError(folder.string(), "is not a folder; give another name");
    refuse_links(folder);
    if (fs::is_directory(folder, error)) return;
    made_ = fs::create_directory(folder, error);
    if (!made_) throw DeviceError(folder.string(), "cannot be created: " + error.message());
    sync_to_disk(folder / "..");
}

RunReportOptions page_options(const DemoOptions& options, const FluxVideo& truth) {
    RunReportOptions page;
    page.title = fmt::format("Stipple demo: scene {}", options.scene);
    page.command = own_command();
    page.area = middle_area(truth.shape(), kPageRows, kPageCols);
    page.quality = trial_quality(truth.slots());
    return page;
}

void demo(const DemoOptions& options, const RunOptions& run) {
    const auto start = std::chrono::steady_clock::now();
    const Scene scene(scene_from_name(options.scene), options.rendering);
    JsonFile json(run);
    const DemoFolder made(options.folder, run.force);
    const fs::path& folder = made.path();
    const FluxVideo truth = render_video(scene, run);
    RunReport report(page_options(options, truth), truth.shape(), &truth);
    const auto results = run_trials(truth, folder, report, run);
    report.fit();
    write_text_file(folder / "report.html", run.force, report.page());
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
    json.write({{"scene", options.scene},
                {"slots", truth.slots()},
                {"rows", truth.shape().rows},
                {"cols", truth.shape().cols},
                {"planes", truth.shape().planes},
                {"seconds", elapsed.count()},
                {"trials", trials_json(results)}});
    run.say(fmt::format(
        "Scene \"{}\": {} slots of 1/200 s, {} x {} RGB, {:.0f} s\n\n{}\n\n"
        "Coded exposure pays where fine detail moves fast. Where a scene has little detail or\n"
        "bright light, binned or short frames do as well (\"stipple rivals\").\n\n"
        "In {}:\n"
        "  side_by_side_1.png ...  as in the table, then the truth; tone-mapped\n"
        "  report.html             the middle of it as an interactive page\n"
        "  decoded.mp4             decoded video, tone-mapped\n"
        "  decoded/                the same as EXR, linear light\n"
        "  random.stipple          the sample stream of this video",
        options.scene, truth.slots(), truth.shape().cols, truth.shape().rows, elapsed.count(),
        trials_table(results), folder.string()));
}

}  // namespace

void add_demo(Command& app, Action& action) {
    Command command = app.add_command("demo", "Render, emulate, decode and compare a scene");
    const auto options = std::make_shared<DemoOptions>();
    command.add_option("-o,--output", options->folder, "folder for all outputs")
        .shows_default()
        .type_name("DIR")
        .output();
    command.add_option("--scene", options->scene, "scene")
        .shows_default()
        .one_of(names_of(scenes()))
        .type_name("NAME");
    add_scene_arguments(command, options->rendering);
    add_threads(command, action.options);
    command.footer(
        "Examples:\n"
        "  stipple demo\n"
        "  stipple demo -o dice_demo --scene dice --frames 32 --size 160x120");
    set_action(command, action, options, demo);
}

}  // namespace stipple
