#include "apps/standard_streams.h"

#include <unistd.h>
#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <mutex>
#include <system_error>

#include "stream/plain_text.h"

namespace stipple {
namespace {

constexpr std::string_view kClearLine = "\r\x1b[K";
std::atomic<bool> bar_is_shown{false};
std::mutex warnings_mutex;
std::vector<std::string> warnings;

constexpr std::string_view kRed = "\x1b[1;31m";
constexpr std::string_view kYellow = "\x1b[1;33m";

/// "error: ", on a terminal in its colour.
std::string level_text(std::string_view level, std::string_view colour) {
    const char* const no_color = std::getenv("NO_COLOR");
    const bool plain = (no_color != nullptr && *no_color != '\0') || !error_is_terminal();
    return plain ? fmt::format("{}: ", level) : fmt::format("{}{}:\x1b[0m ", colour, level);
}

void say(std::string_view level, std::string_view colour, std::string_view text) noexcept {
    try {
        std::string line(bar_is_shown.exchange(false) ? kClearLine : "");
        line += "stipple: ";
        if (!level.empty()) line += level_text(level, colour);
        write_error_text(line.append(terminal_text(text)).append("\n"));
    } catch (...) {  // no memory for it
        write_error_text("stipple: ");
        write_error_text(level);
        write_error_text(level.empty() ? "" : ": ");
        write_error_text(kNoMemory);
        write_error_text("\n");
    }
}

}  // namespace

bool error_is_terminal() noexcept {
    const char* const terminal = std::getenv("TERM");
    return isatty(STDERR_FILENO) != 0 &&
           (terminal == nullptr || std::strcmp(terminal, "dumb") != 0);
}

void write_error_text(std::string_view text) noexcept {
    while (!text.empty()) {
        const auto written = write(STDERR_FILENO, text.data(), text.size());
        if (written < 0 && errno == EINTR) continue;
        if (written <= 0) return;
        text.remove_prefix(static_cast<std::size_t>(written));
    }
}

void show_bar(std::string_view line) noexcept {
    bar_is_shown = !line.empty();
    try {
        write_error_text(std::string(kClearLine).append(line));
    } catch (...) {  // no memory: no bar
    }
}

bool clear_bar() noexcept {
    const bool shown = bar_is_shown.exchange(false);
    if (shown) write_error_text(kClearLine);
    return shown;
}

void say_note(std::string_view text) noexcept {
    say({}, {}, text);
}

void say_error(std::string_view text) noexcept {
    say("error", kRed, text);
}

void say_warning(std::string_view text) noexcept {
    if (text.empty()) return;
    say("warning", kYellow, text);
    try {
        const std::lock_guard lock(warnings_mutex);
        if (std::ranges::find(warnings, text) == warnings.end()) warnings.emplace_back(text);
    } catch (...) {  // no memory: it was at least said
    }
}

std::string in_options(const Parameter& parameter) {
    const auto& [name, value] = parameter;
    if (name.find('.') != std::string::npos)
        return "--set " + name + (value.empty() ? "" : "=" + value);
    std::string option = "--" + name;
    std::ranges::replace(option, '_', '-');
    return value.empty() || value == "true" ? option : option + " " + value;
}

std::vector<std::string> said_warnings() {
    const std::lock_guard lock(warnings_mutex);
    return warnings;
}

void print_text(std::string_view text) {
    if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size())
        throw std::system_error(errno, std::generic_category(), "standard output");
}

void flush_output() {
    if (std::fflush(stdout) != 0)
        throw std::system_error(errno, std::generic_category(), "standard output");
}

}  // namespace stipple
