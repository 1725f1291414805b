#include "apps/standard_output.h"

#include <cerrno>
#include <cstdio>
#include <system_error>

namespace stipple {

void print_text(std::string_view text) {
    if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size())
        throw std::system_error(errno, std::generic_category(), "standard output");
}

}  // namespace stipple
