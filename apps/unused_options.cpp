#include "apps/unused_options.h"

#include <CLI/CLI.hpp>

namespace stipple {

void refuse_options(const CLI::App& command, std::initializer_list<const char*> names,
                    const std::string& why) {
    for (const char* name : names)
        if (command.count(name) > 0) throw CLI::ValidationError(name, why);
}

}  // namespace stipple
