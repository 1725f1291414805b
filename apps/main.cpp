#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
#include <exception>
#include <new>
#include <optional>
#include <string_view>
#include <system_error>

#include "apps/command_line.h"
#include "apps/interrupt.h"
#include "apps/run_options.h"
#include "apps/standard_error.h"
#include "apps/subcommands.h"
#include "core/disk_sync.h"
#include "core/error.h"
#include "core/memory_limit.h"
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
    "\"stipple help SUBCOMMAND\" says more. Exit codes: 0 done, 1 an input cannot be used,\n"
    "2 wrong command line, 3 an output or device failed, 130 and 143 stopped by Ctrl-C or SIGTERM\n"
    "(outputs are then complete files of fewer frames).";

int fail(ExitCode code, std::string_view message) {
    say_error(message);
    return code;
}

ExitCode signal_code() {
    return static_cast<ExitCode>(kSignal + stop_signal());
}

/// Does `action` and hands its last words on standard output to the system.
int run(const Action& action) {
    try {
        const ThreadLimit limit(action.options.threads);
        std::optional<NoSync> no_sync;
        if (action.options.no_sync) no_sync.emplace();
        std::optional<MemoryLimit> memory;
        if (action.options.max_memory > 0) memory.emplace(action.options.max_memory);
        action.run(action.options);
        if (std::fflush(stdout) != 0)
            throw std::system_error(errno, std::generic_category(), "standard output");
    } catch (const InputError& e) {
        // An input that a signal has cut short is none to complain of.
        return stop_signal() == 0 ? fail(kInput, e.what()) : fail(signal_code(), "stopped");
    } catch (const Interrupted& e) {
        return fail(signal_code(), e.left.empty() ? "stopped" : fmt::format("stopped; {}", e.left));
    } catch (const std::bad_alloc&) {
        return fail(kDevice, "not enough memory");
    } catch (const std::exception& e) {
        return fail(kDevice, e.what());
    }
    if (stop_signal() == 0) return kOk;
    return fail(signal_code(), "stopped; the output is shorter");
}

int main(int argc, char** argv) {
    occupy_standard_streams();
    Action action;
    CommandLine line(
        "stipple",
        "Stipple: emulate a coded-exposure sensor, decode its stream to high-speed video",
        STIPPLE_VERSION);
    Command root = line.root();
    root.footer(kExamples);
    for (const auto add :
         {add_synth, add_emulate, add_decode, add_compare, add_info, add_recover, add_schedule,
          add_timing, add_characterize, add_capture, add_demo, add_list})
        add(root, action);
    for (Command& command : root.leaves()) add_run_options(command, action.options);
    switch (line.parse(argc, argv)) {
        case CommandLine::Parsed::kHelp:
            action.run = [](const RunOptions&) {};  // standard output may be a full disk
            return run(action);
        case CommandLine::Parsed::kWrong:
            return kUsage;
        case CommandLine::Parsed::kAction:
            break;
    }
    catch_signals();
    return run(action);
}

}  // namespace
}  // namespace stipple

int main(int argc, char** argv) {
    return stipple::main(argc, argv);
}
