#include <cxxabi.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cstdlib>
#include <exception>
#include <new>
#include <optional>
#include <string_view>
#include <system_error>
#include <typeinfo>

#include "apps/arguments/command_line.h"
#include "apps/arguments/run_options.h"
#include "apps/interrupt.h"
#include "apps/standard_streams.h"
#include "apps/subcommands.h"
#include "capture/open_camera.h"
#include "core/error.h"
#include "core/memory_limit.h"
#include "core/parallel.h"
#include "core/version.h"
#include "io/disk_sync.h"
#include "io/pending_output.h"

namespace stipple {
namespace {

enum ExitCode { kOk = 0, kInput = 1, kUsage = 2, kDevice = 3, kSignal = 128, kNoReader = 141 };

constexpr auto kExamples =
    "Examples:\n"
    "  stipple demo                                      everything at once, no file needed\n"
    "  stipple synth pan -o scene                        render footage\n"
    "  stipple emulate scene -o clip.stipple             through the sensor\n"
    "  stipple decode clip.stipple -o decoded            back to video\n"
    "  stipple compare decoded scene --max-value 2       how good it is\n"
    "See \"stipple help SUBCOMMAND\" for details. Exit codes: 0 done, 1 an input cannot be used,\n"
    "2 wrong command line, 3 an output or device failed, 130 and 143 stopped by Ctrl-C or SIGTERM\n"
    "(outputs are then complete files of fewer frames), 141 nobody reads standard output.";

constexpr std::string_view kNoThread =
    "no further thread can be started; end other programs, or raise the limit (ulimit -u)";

/// Names the partial outputs that no message has named. Needs no memory.
void say_what_is_left() {
    visit_partial_outputs([](const char* path) {
        if (access(path, F_OK) != 0) return;  // not yet created
        write_error_text("stipple: left beside the outputs: ");
        write_error_text(path);
        write_error_text("\n");
    });
}

int fail(ExitCode code, std::string_view message) {
    say_error(message);
    say_what_is_left();
    return code;
}

int fail(ExitCode code, const Error& error) {
    try {
        return fail(code, std::string_view(error.message().text(in_options)));
    } catch (const std::bad_alloc&) {
        return fail(code, std::string_view(error.what()));
    }
}

/// The handler of std::terminate(): noexcept functions of libraries end here if there is no memory,
/// some of libstdc++ without an exception.
[[noreturn]] void end_in_a_library() {
    const std::type_info* const thrown = abi::__cxa_current_exception_type();
    if (thrown != nullptr && *thrown != typeid(std::bad_alloc)) std::abort();
    std::_Exit(fail(kDevice, kNoMemory));
}

/// The end of a run that a signal has stopped.
int stop(std::string_view message) {
    say_note(message);
    say_what_is_left();
    return kSignal + stop_signal();
}

void run(const Action& action) {
    catch_signals();
    tell_camera_messages([](std::string_view text) { say_warning("camera: {}", text); });
    const ThreadLimit limit(action.options.threads);
    std::optional<NoSync> no_sync;
    if (action.options.no_sync) no_sync.emplace();
    std::optional<MemoryLimit> memory;
    if (action.options.max_memory > 0) memory.emplace(action.options.max_memory);
    action.run(action.options);
}

/// Runs the command line, if it is right, and flushes standard output, so that a failed write is an
/// error.
CommandLine::Parsed run(int argc, char** argv) {
    Action action;
    CommandLine line(
        "stipple",
        "Stipple: emulate a coded-exposure sensor, decode its stream to high-speed video",
        version());
    Command root = line.root();
    root.footer(kExamples);
    for (const auto add :
         {add_synth,   add_emulate,      add_chip,      add_import,     add_export,   add_decode,
          add_join,    add_compare,      add_info,      add_recover,    add_schedule, add_timing,
          add_rtl,     add_characterize, add_calibrate, add_dictionary, add_capture,  add_demo,
          add_explore, add_rivals,       add_report,    add_view,       add_list})
        add(root, action);
    for (Command& command : root.leaves()) add_run_options(command, action.options);
    add_manual(root, action, [&line] { return line.description(); });
    const auto parsed = line.parse(argc, argv);
    action.options.notes_only = line.writes_to_standard_output();
    if (parsed == CommandLine::Parsed::kAction) run(action);
    flush_output();
    return parsed;
}

int main(int argc, char** argv) {
    reserve_standard_streams();
    std::set_terminate(end_in_a_library);
    try {
        if (run(argc, argv) == CommandLine::Parsed::kWrong) return kUsage;
    } catch (const InputError& e) {
        // A signal cuts inputs short: then the input is not to blame.
        return stop_signal() == 0 ? fail(kInput, e) : stop("stopped");
    } catch (const DeviceError& e) {
        return fail(kDevice, e);
    } catch (const Interrupted& e) {
        return stop(e.left.empty() ? "stopped" : fmt::format("stopped; {}", e.left));
    } catch (const std::bad_alloc&) {
        return fail(kDevice, kNoMemory);
    } catch (const std::system_error& e) {
        // Of standard output, as of `stipple list keys | head -1`: as if SIGPIPE had ended it.
        if (e.code() == std::errc::broken_pipe) {
            say_what_is_left();
            return kNoReader;
        }
        const bool no_thread = e.code() == std::errc::resource_unavailable_try_again;
        return fail(kDevice, no_thread ? kNoThread : e.what());
    } catch (const std::exception& e) {
        return fail(kDevice, e.what());
    }
    if (stop_signal() == 0) return kOk;
    return stop("stopped; the output is shorter");
}

}  // namespace
}  // namespace stipple

int main(int argc, char** argv) {
    return stipple::main(argc, argv);
}
