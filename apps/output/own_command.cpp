#include "apps/output/own_command.h"

#include <fstream>

#include "core/text.h"

namespace stipple {

std::string own_command() {
    std::ifstream file("/proc/self/cmdline", std::ios::binary);
    std::string argument;
    if (!std::getline(file, argument, '\0')) return {};
    std::string command = "stipple";
    while (std::getline(file, argument, '\0')) command += ' ' + shell_quoted(argument);
    return command;
}

}  // namespace stipple
