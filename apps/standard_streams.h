#pragma once

#include <fmt/format.h>
#include <concepts>
#include <new>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/message.h"
#include "stream/plain_text.h"

namespace stipple {

// Standard error may be a full disk, a pipe that nobody reads, or closed: text that
// cannot be written is dropped, and the run goes on.

constexpr std::string_view kNoMemory =
    "not enough memory; end other programs, or give smaller or fewer frames";

/// Whether it is a terminal that knows more than lines.
[[nodiscard]] bool error_is_terminal() noexcept;

/// Writes `text` as it is.
void write_error_text(std::string_view text) noexcept;

/// Shows `line` (our own words and numbers) in place of the last one, on a terminal; an empty one
/// takes it away.
void show_bar(std::string_view line) noexcept;

/// Takes away the bar that is shown, if one is: other text is about to come. Safe in a signal
/// handler. Returns whether there was one.
bool clear_bar() noexcept;

/// A line of its own, "stipple: " before it, as `terminal_text`: what is no warning and no error.
void say_note(std::string_view text) noexcept;

/// The same for the error that ends the run: "stipple: error: ". On a terminal the level is
/// coloured, unless the variable NO_COLOR is set.
void say_error(std::string_view text) noexcept;

/// The same for a warning, "stipple: warning: "; nothing if it is empty.
void say_warning(std::string_view text) noexcept;

/// A parameter as an option of the command line: "--fill-gaps", "--set sensor.slot_us=5000".
[[nodiscard]] std::string in_options(const Parameter& parameter);

/// The same with parameters as options.
template <std::same_as<Message> Text>
void say_warning(const Text& message) noexcept {
    say_warning(std::string_view(message.text(in_options)));
}

/// The warnings so far, each once.
[[nodiscard]] std::vector<std::string> said_warnings();

/// Formatted.
template <typename... Arguments>
requires(sizeof...(Arguments) > 0) void say_note(fmt::format_string<Arguments...> format,
                                                 Arguments&&... arguments) {
    say_note(std::string_view(fmt::format(format, std::forward<Arguments>(arguments)...)));
}

template <typename... Arguments>
requires(sizeof...(Arguments) > 0) void say_warning(fmt::format_string<Arguments...> format,
                                                    Arguments&&... arguments) {
    say_warning(std::string_view(fmt::format(format, std::forward<Arguments>(arguments)...)));
}

constexpr auto kAllBefore = [] { return "what was written before is"; };

/// Tells that the data written to `output` by a failed run are kept; without the name if there is
/// no memory for it.
template <typename Text = decltype(kAllBefore)>
void report_kept(const char* output, Text what = kAllBefore) noexcept {
    try {
        const std::string line =
            fmt::format("stipple: {}: {} kept\n", terminal_text(output), what());
        clear_bar();
        write_error_text(line);
    } catch (const std::bad_alloc&) {
        write_error_text("stipple: what was written before is kept\n");
    }
}

/// Writes text to standard output. \throws std::system_error at "standard output" if it cannot be
/// written.
void print_text(std::string_view text);
/// Hands over what was printed so far. \throws std::system_error as print_text.
void flush_output();

}  // namespace stipple
