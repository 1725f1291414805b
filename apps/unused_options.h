#pragma once

#include <initializer_list>
#include <string>

namespace CLI {
class App;
}

namespace stipple {

/// For callbacks of `command`. \throws CLI::ValidationError naming the first of these options that
/// was given, although it does nothing here; `why` says so and what to do.
void refuse_options(const CLI::App& command, std::initializer_list<const char*> names,
                    const std::string& why);

}  // namespace stipple
