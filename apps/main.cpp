#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <exception>
#include <new>
#include <span>
#include <string_view>
#include <system_error>

#include "apps/interrupt.h"
#include "apps/run_options.h"
#include "apps/subcommands.h"
#include "core/error.h"
#include "core/parallel.h"

namespace stipple {
namespace {

enum ExitCode { kOk = 0, kInput = 1, kUsage = 2, kDevice = 3, kSignal = 128 };

constexpr auto kExamples =
    "Examples:\n"
    "  stipple demo                                      everything at once, no file needed\n"
    "  stipple synth pan -o scene                        render footage\n"
    "  stipple emulate scene -o clip.stipple             through the sensor\n"
    "  stipple decode clip.stipple -o decoded            back to video\n"
    "  stipple compare decoded scene --max-value 2       how good it is\n"
    "\"stipple SUBCOMMAND --help\" says more. Exit codes: 0 done, 1 an input cannot be used,\n"
    "2 wrong command line, 3 an output or device failed, 130 and 143 stopped by Ctrl-C or SIGTERM\n"
    "(outputs are then complete files of fewer frames).";

int fail(ExitCode code, std::string_view message) {
    fmt::print(stderr, "stipple: {}\n", message);
    return code;
}

/// Runs `action` and hands its last words on standard output to the system.
int run(const Action& action, const RunOptions& options) {
    try {
        const ThreadLimit limit(options.threads);
        action(options);
        if (std::fflush(stdout) != 0)
            throw std::system_error(errno, std::generic_category(), "standard output");
    } catch (const InputError& e) {
        return fail(kInput, e.what());
    } catch (const Interrupted&) {
        return fail(static_cast<ExitCode>(kSignal + stop_signal()), "stopped");
    } catch (const std::bad_alloc&) {
        return fail(kDevice, "not enough memory");
    } catch (const std::exception& e) {
        return fail(kDevice, e.what());
    }
    if (stop_signal() == 0) return kOk;
    return fail(static_cast<ExitCode>(kSignal + stop_signal()), "stopped; the output is shorter");
}

/// To each subcommand that does something, however deep.
void add_run_options_to_all(CLI::App& app, RunOptions& options) {
    for (CLI::App* command : app.get_subcommands({}))
        command->get_subcommands({}).empty() ? add_run_options(*command, options)
                                             : add_run_options_to_all(*command, options);
}

/// The word of the command line that stands for a subcommand and is none, or null. CLI11 says of it
/// only that a subcommand is missing.
const char* unknown_subcommand(CLI::App& app, std::span<char* const> words) {
    CLI::App* command = &app;
    for (const char* word : words) {
        const auto choices = command->get_subcommands({});
        if (choices.empty() || word[0] == '-') return nullptr;
        const auto chosen = std::ranges::find_if(
            choices, [&](const CLI::App* choice) { return choice->check_name(word); });
        if (chosen == choices.end()) return word;
        command = *chosen;
    }
    return nullptr;
}

int main(int argc, char** argv) {
    RunOptions options;
    Action action;
    CLI::App app("Stipple: emulate a coded-exposure sensor, decode its stream to high-speed video",
                 "stipple");
    app.set_version_flag("--version", "stipple " STIPPLE_VERSION);
    app.footer(kExamples);
    app.require_subcommand(1);
    for (const auto add : {add_synth, add_emulate, add_decode, add_compare, add_info, add_schedule,
                           add_timing, add_characterize, add_capture, add_demo})
        add(app, action);
    add_run_options_to_all(app, options);
    if (const char* word = unknown_subcommand(app, {argv + 1, argv + argc}))
        return fail(kUsage, fmt::format("there is no subcommand \"{}\"; --help lists them", word));
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& e) {
        return app.exit(e) == 0 ? kOk : kUsage;
    }
    catch_signals();
    return run(action, options);
}

}  // namespace
}  // namespace stipple

int main(int argc, char** argv) {
    return stipple::main(argc, argv);
}
