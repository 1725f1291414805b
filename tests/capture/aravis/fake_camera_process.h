#pragma once

#include <fcntl.h>
#include <gtest/gtest.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <cstring>
#include <string>
#include <vector>

#include "tests/support/source_tree.h"

extern char** environ;

namespace stipple {

/// A fake camera at work, from READY on: tests/capture/aravis/fake_gige_camera.cpp, or another
/// program that is built here and takes commands as it does.
class FakeCameraProcess {
  public:
    /// `options` as in the head of fake_gige_camera.cpp.
    explicit FakeCameraProcess(std::vector<std::string> options = {},
                               std::string program = "fake_gige_camera")
        : options_(std::move(options)), program_(built_program(program).string()) {
        start();
    }
    ~FakeCameraProcess() {
        if (pid_ > 0) end(SIGKILL);
    }
    FakeCameraProcess(const FakeCameraProcess&) = delete;
    FakeCameraProcess& operator=(const FakeCameraProcess&) = delete;

    void start() {
        std::array<int, 2> commands{};
        std::array<int, 2> answers{};
        ASSERT_EQ(pipe2(commands.data(), O_CLOEXEC), 0);
        ASSERT_EQ(pipe2(answers.data(), O_CLOEXEC), 0);
        posix_spawn_file_actions_t actions;
        posix_spawn_file_actions_init(&actions);
        posix_spawn_file_actions_adddup2(&actions, commands[0], STDIN_FILENO);
        posix_spawn_file_actions_adddup2(&actions, answers[1], STDOUT_FILENO);
        std::vector<char*> arguments{program_.data()};
        for (std::string& option : options_) arguments.push_back(option.data());
        arguments.push_back(nullptr);
        const int error =
            posix_spawn(&pid_, program_.c_str(), &actions, nullptr, arguments.data(), environ);
        posix_spawn_file_actions_destroy(&actions);
        ::close(commands[0]);
        ::close(answers[1]);
        commands_ = commands[1];
        answers_ = answers[0];
        ASSERT_EQ(error, 0) << program_;
        ASSERT_EQ(answer(), "READY");
    }

    /// Pulls the plug: no goodbye to the client.
    void kill() { end(SIGKILL); }
    void freeze() const {
        ::kill(pid_, SIGSTOP);
        ::waitpid(pid_, nullptr, WUNTRACED);  // it may still answer before it stops
    }
    void thaw() const { ::kill(pid_, SIGCONT); }

    /// Writes a register behind the client's back.
    void write_register(unsigned address, unsigned value) {
        command(std::to_string(address) + " " + std::to_string(value));
    }

    void command(std::string line) {
        line += '\n';
        ASSERT_EQ(::write(commands_, line.data(), line.size()), static_cast<ssize_t>(line.size()));
        ASSERT_EQ(answer(), "DONE");
    }

  private:
    /// The next line that it prints, without its end.
    std::string answer() const {
        std::string line;
        for (char next = 0; ::read(answers_, &next, 1) == 1 && next != '\n';) line += next;
        return line;
    }

    void end(int signal) {
        ::kill(pid_, signal);
        ::waitpid(pid_, nullptr, 0);
        ::close(commands_);
        ::close(answers_);
        pid_ = 0;
    }

    std::vector<std::string> options_;
    std::string program_;
    pid_t pid_ = 0;
    int commands_ = -1;
    int answers_ = -1;
};

}  // namespace stipple
