#pragma once

#include <functional>
#include <memory>
#include <utility>

#include "apps/command_line.h"
#include "apps/run_options.h"

namespace stipple {

/// What the command line asks for.
struct Action {
    std::function<void(const RunOptions&)> run;  ///< what the subcommand that it names does
    RunOptions options;
};

/// If the command line names `command` and `check` does not refuse it (UsageError), `run` is what
/// is done, with `options`.
template <typename Options>
void set_action(
    Command& command, Action& action, const std::shared_ptr<Options>& options,
    void (*run)(const Options&, const RunOptions&), std::function<void()> check = [] {}) {
    command.callback([&action, options, run, check = std::move(check)] {
        check();
        action.run = [options, run](const RunOptions& told) { run(*options, told); };
    });
}

}  // namespace stipple
