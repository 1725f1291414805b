#include "apps/chart.h"

#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>

#include "core/error.h"

namespace stipple {
namespace {

struct Closer {
    void operator()(std::FILE* file) const { std::fclose(file); }
};
using Scratch = std::unique_ptr<std::FILE, Closer>;

/// A file without a name, gone when it is closed.
Scratch scratch_file() {
    Scratch file(std::tmpfile());
    if (!file) throw DeviceError("gnuplot", "no temporary file: " + std::string(strerror(errno)));
    return file;
}

std::string text_of(std::FILE* file) {
    std::string text(4096, '\0');
    std::rewind(file);
    text.resize(std::fread(text.data(), 1, text.size(), file));
    return text;
}

/// Runs gnuplot on what `script` holds; its words go to `log`. Returns its exit status.
int run_gnuplot(std::FILE* script, std::FILE* log) {
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, fileno(script), STDIN_FILENO);
    posix_spawn_file_actions_adddup2(&actions, fileno(log), STDOUT_FILENO);
    posix_spawn_file_actions_adddup2(&actions, fileno(log), STDERR_FILENO);
    std::string name = "gnuplot", no_start_file = "--default-settings";
    char* const arguments[] = {name.data(), no_start_file.data(), nullptr};
    pid_t child = 0;
    const int problem = posix_spawnp(&child, arguments[0], &actions, nullptr, arguments, environ);
    posix_spawn_file_actions_destroy(&actions);
    if (problem != 0)
        throw DeviceError("gnuplot", fmt::format("{}; charts need it: install the package "
                                                 "gnuplot-nox",
                                                 strerror(problem)));
    int status = 0;
    while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    return status;
}

std::string terminal_of(const std::filesystem::path& file, ChartSize size) {
    const auto extension = file.extension();
    if (extension == ".png")
        return fmt::format("set terminal pngcairo size {},{} noenhanced font 'DejaVu Sans,11'\n",
                           size.width, size.height);
    if (extension == ".svg")
        return fmt::format(
            "set terminal svg size {},{} noenhanced background 'white' font 'DejaVu Sans,11'\n",
            size.width, size.height);
    throw InputError(file.string(), "a chart is a .png or a .svg");
}

/// gnuplot's single quotes: a quote within is written twice.
std::string quoted(const std::string& text) {
    std::string result = "'";
    for (const char c : text) result += c == '\'' ? std::string("''") : std::string(1, c);
    return result + "'";
}

}  // namespace

void draw_chart(const std::filesystem::path& file, ChartSize size, const std::string& commands) {
    const Scratch script = scratch_file();
    const Scratch log = scratch_file();
    const std::string text = terminal_of(file, size) + "set output " + quoted(file.string()) +
                             "\n" + commands + "\nset output\n";
    if (std::fwrite(text.data(), 1, text.size(), script.get()) != text.size() ||
        std::fflush(script.get()) != 0 || fseek(script.get(), 0, SEEK_SET) != 0)
        throw DeviceError("gnuplot", "no room for its commands: " + std::string(strerror(errno)));
    if (run_gnuplot(script.get(), log.get()) != 0)
        throw DeviceError(file.string(), "gnuplot failed: " + text_of(log.get()));
}

}  // namespace stipple
