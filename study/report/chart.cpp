#include "study/report/chart.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <utility>

namespace stipple {
namespace {

constexpr const char* kGnuplot = "gnuplot";

[[noreturn]] void fail(const std::string& problem) {
    throw DeviceError(kGnuplot, problem);
}

/// A descriptor that is closed at the end.
class Descriptor {
  public:
    explicit Descriptor(int descriptor) : descriptor_(descriptor) {
        if (descriptor_ < 0) fail(strerror(errno));
    }
    ~Descriptor() { reset(); }
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    void reset() {
        if (descriptor_ >= 0) close(std::exchange(descriptor_, -1));
    }
    [[nodiscard]] int get() const { return descriptor_; }

  private:
    int descriptor_;
};

/// All that comes from here on.
std::string read_all(const Descriptor& source) {
    std::string text;
    for (std::array<char, 65536> part;;) {
        const auto bytes = read(source.get(), part.data(), part.size());
        if (bytes < 0 && errno == EINTR) continue;
        if (bytes < 0) fail(strerror(errno));
        if (bytes == 0) return text;
        text.append(part.data(), static_cast<std::size_t>(bytes));
    }
}

pid_t start_gnuplot(const Descriptor& script, const Descriptor& image, const Descriptor& log) {
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, script.get(), STDIN_FILENO);
    posix_spawn_file_actions_adddup2(&actions, image.get(), STDOUT_FILENO);
    posix_spawn_file_actions_adddup2(&actions, log.get(), STDERR_FILENO);
    std::string name = kGnuplot, no_start_file = "--default-settings";
    char* const arguments[] = {name.data(), no_start_file.data(), nullptr};
    pid_t child = 0;
    const int problem = posix_spawnp(&child, arguments[0], &actions, nullptr, arguments, environ);
    posix_spawn_file_actions_destroy(&actions);
    if (problem != 0)
        throw NoGnuplot(kGnuplot, fmt::format("{}; charts need it: install the package gnuplot-nox",
                                              strerror(problem)));
    return child;
}

std::string terminal_of(std::string_view extension, ChartSize size) {
    return fmt::format("set terminal {} size {},{} noenhanced {}font 'DejaVu Sans,11'\n",
                       extension == ".svg" ? "svg" : "pngcairo", size.width, size.height,
                       extension == ".svg" ? "background 'white' " : "");
}

}  // namespace

// The image comes through a pipe, because gnuplot does not notice failed writes to a file.
std::string draw_chart(std::string_view extension, ChartSize size, const std::string& commands) {
    const Descriptor script(memfd_create(kGnuplot, MFD_CLOEXEC));
    const Descriptor log(memfd_create(kGnuplot, MFD_CLOEXEC));
    const std::string text = terminal_of(extension, size) + commands + "\n";
    if (pwrite(script.get(), text.data(), text.size(), 0) != static_cast<ssize_t>(text.size()))
        fail("there is no room for its commands");
    std::array<int, 2> pipe{-1, -1};
    if (pipe2(pipe.data(), O_CLOEXEC) != 0) fail(strerror(errno));
    const Descriptor output(pipe[0]);
    Descriptor input(pipe[1]);
    const pid_t child = start_gnuplot(script, input, log);
    input.reset();
    std::string chart = read_all(output);
    int status = 0;
    while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    lseek(log.get(), 0, SEEK_SET);
    if (status != 0 || chart.empty()) fail(fmt::format("failed: {}", read_all(log)));
    return chart;
}

}  // namespace stipple
