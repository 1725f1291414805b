#include <fmt/format.h>

#include <cstdint>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <system_error>

#include "apps/interrupt.h"
#include "apps/output/json_file.h"
#include "apps/subcommands.h"
#include "capture/recording/recovery.h"
#include "core/error.h"
#include "io/output_names.h"
#include "io/partial_output.h"

namespace stipple {
namespace fs = std::filesystem;
namespace {

struct RecoverOptions {
    std::string path = ".";
    std::string output;  ///< empty: the name that it was going to have
};

const char* name_of(Recoverable kind) {
    if (kind == Recoverable::kNo) return nullptr;
    return kind == Recoverable::kStream ? "stream" : "recording";
}

void list_leftovers(const fs::path& folder, const RunOptions& run) {
    std::error_code unreadable;
    static_cast<void>(fs::directory_iterator(folder, unreadable));
    if (unreadable) throw InputError(folder.string(), "cannot be listed: " + unreadable.message());
    JsonFile json(run);
    auto left = nlohmann::ordered_json::array();
    for (const PartialOutput& partial : partial_outputs(folder)) {
        if (partial.running()) continue;
        const char* const kind = name_of(recoverable(partial.path));
        std::error_code error;
        const bool file = fs::is_regular_file(partial.path, error);
        const std::uint64_t bytes = file ? fs::file_size(partial.path, error) : 0;
        const std::string final_name = partial.final_path.filename().string();
        left.push_back({{"file", partial.path.string()},
                        {"output", final_name},
                        {"kind", nullptr},
                        {"bytes", bytes},
                        {"process", partial.process}});
        if (kind != nullptr) left.back()["kind"] = kind;
        run.say(fmt::format(
            "{}: {}{}", partial.path.string(),
            file ? fmt::format("{:.1f} MB, ", static_cast<double>(bytes) * 1e-6) : "a folder, ",
            kind != nullptr ? fmt::format("a {} that becomes {}", kind, final_name)
                            : fmt::format("of {}, cannot be recovered; delete it", final_name)));
    }
    if (left.empty()) run.say("no run that was killed has left anything here");
    json.write({{"left", left}});
}

/// The whole part of a recovered file.
std::string recovered_text(const fs::path& output, const Recovered& recovered) {
    std::string text = fmt::format("{}: {} whole {}", output.string(), recovered.whole,
                                   recovered.kind == Recoverable::kStream ? "slots" : "frames");
    if (recovered.cut_bytes > 0)
        text += fmt::format(", {} bytes of the next one cut off", recovered.cut_bytes);
    return text + (recovered.complete ? "; it is complete"
                                      : "; without an end, which marks it as cut off");
}

void recover_file(const RecoverOptions& options, const RunOptions& run) {
    const fs::path file(options.path);
    const auto partial = partial_output(file);
    if (partial && partial->running())
        throw InputError(options.path, fmt::format("process {} is writing it; stop that first",
                                                   partial->process));
    if (!partial && options.output.empty())
        throw InputError(options.path,
                         "has no name of an unfinished output (.name.PROCESS-RANDOM.partial.ext), "
                         "so say with -o what it shall be called");
    JsonFile json(run);
    const fs::path output = options.output.empty() ? partial->final_path : fs::path(options.output);
    const Recovered recovered = recover(file, output, [] { throw_if_stopped(); });
    json.write({{"file", output.string()},
                {"whole", recovered.whole},
                {"cut_bytes", recovered.cut_bytes}});
    run.say(recovered_text(output, recovered));
}

void run_recover(const RecoverOptions& options, const RunOptions& run) {
    std::error_code error;
    const auto status = fs::status(options.path, error);
    if (!fs::exists(status)) throw InputError(options.path, "there is no such file or folder");
    if (!fs::is_directory(status)) return recover_file(options, run);
    if (partial_output(options.path))
        throw InputError(options.path,
                         "is a folder of frames that cannot be recovered: the last one may be cut "
                         "off; delete it, or take out what you need");
    if (!options.output.empty())
        throw InputError(options.path,
                         "is a folder; -o names one file, so give the file to recover");
    list_leftovers(options.path, run);
}

}  // namespace

void add_recover(Command& app, Action& action) {
    Command command =
        app.add_command("recover", "List and recover unfinished outputs of killed runs");
    const auto options = std::make_shared<RecoverOptions>();
    command
        .add_option("PATH", options->path,
                    "folder whose unfinished outputs are listed, or the file to keep")
        .default_text("this folder");
    command
        .add_option("-o,--output", options->output,
                    "new name of the file; existing files are never replaced")
        .default_text("the name of the output")
        .type_name("FILE")
        .output(kRecoveredName);
    command.footer(
        "Examples:\n"
        "  stipple recover                                      list what lies in this folder\n"
        "  stipple recover .clip.4711-5e1f00d5.partial.strec    keep it as clip.strec\n"
        "  stipple recover .clip.4711-5e1f00d5.partial.strec -o saved.strec\n"
        "Streams and recordings are whole up to their last packet or frame. Nothing else is.");
    set_action(command, action, options, run_recover);
}

}  // namespace stipple
