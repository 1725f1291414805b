#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include "apps/output/manual.h"
#include "apps/standard_streams.h"
#include "apps/subcommands.h"
#include "core/version.h"
#include "io/pending_output.h"
#include "io/text_file.h"

namespace stipple {
namespace {

/// Arguments of the two commands about the command line itself.
struct ManualOptions {
    std::string argument;  ///< a folder, or a shell
    bool markdown = false;
    std::function<CommandDescription()> describe;
};

bool is_page_name(std::string_view name) {
    return name.starts_with("stipple") && (name.ends_with(".1") || name.ends_with(".md"));
}

void write_pages(const CommandDescription& command, const PendingOutput& folder, bool markdown) {
    const std::string name = manual_page_name(command) + (markdown ? ".md" : ".1");
    write_whole(folder.partial() / name, (folder.final_path() / name).string(),
                markdown ? markdown_page(command) : manual_page(command, version()));
    for (const CommandDescription& below : command.commands) write_pages(below, folder, markdown);
}

void write_manual(const ManualOptions& options, const RunOptions& run) {
    PendingOutput folder(options.argument, run.force, OutputKind::kFolder, is_page_name);
    write_pages(options.describe(), folder, options.markdown);
    folder.commit();
}

void print_completion(const ManualOptions& options, const RunOptions&) {
    print_text(completion(options.describe(), options.argument));
}

}  // namespace

void add_manual(Command& app, Action& action, std::function<CommandDescription()> describe) {
    const auto options = std::make_shared<ManualOptions>();
    options->describe = std::move(describe);
    Command manual = app.add_command("manual", "Manual pages of all commands");
    manual.add_option("FOLDER", options->argument, "folder to write the pages to")
        .required()
        .output();
    manual.add_flag("--markdown", options->markdown, "write tables of options as Markdown instead");
    manual.add_flag("--force", action.options.force,
                    "replace the folder, if it holds nothing but such pages");
    manual.footer(
        "Examples:\n"
        "  stipple manual man1\n"
        "  man man1/stipple-emulate.1\n"
        "  stipple manual capture record                   shows the options of a command\n"
        "  stipple manual pages --markdown");
    set_action(manual, action, options, write_manual);

    Command completion = app.add_command("completion", "Completion of the command line in a shell");
    completion.add_option("SHELL", options->argument, "shell")
        .one_of({"bash", "zsh", "fish"})
        .required();
    completion.footer(
        "Examples:\n"
        "  source <(stipple completion bash)\n"
        "  stipple completion zsh > ~/.zfunc/_stipple      # a folder of $fpath\n"
        "  stipple completion fish > ~/.config/fish/completions/stipple.fish");
    set_action(completion, action, options, print_completion);
}

}  // namespace stipple
