#include "apps/report/own_command.h"

#include <fstream>
#include <string_view>

namespace stipple {
namespace {

/// An argument as a shell takes it.
std::string shell_quoted(const std::string& argument) {
    constexpr std::string_view kPlain =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_./=:,%+@-";
    if (!argument.empty() && argument.find_first_not_of(kPlain) == std::string::npos)
        return argument;
    std::string text = "'";
    for (const char c : argument) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return text + "'";
}

}  // namespace

std::string own_command() {
    std::ifstream file("/proc/self/cmdline", std::ios::binary);
    std::string argument;
    if (!std::getline(file, argument, '\0')) return {};
    std::string command = "stipple";
    while (std::getline(file, argument, '\0')) command += ' ' + shell_quoted(argument);
    return command;
}

}  // namespace stipple
