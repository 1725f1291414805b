#include "apps/standard_error.h"

#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <string>

#include "stream/plain_text.h"

namespace stipple {
namespace {

constexpr std::string_view kClearLine = "\r\x1b[K";
std::atomic<bool> bar_is_shown{false};

}  // namespace

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

void say_error(std::string_view text) noexcept {
    try {
        std::string line(bar_is_shown.exchange(false) ? kClearLine : "");
        write_error_text(line.append("stipple: ").append(terminal_text(text)).append("\n"));
    } catch (...) {  // no memory for it
        write_error_text("stipple: ");
        write_error_text(kNoMemory);
        write_error_text("\n");
    }
}

}  // namespace stipple
