#pragma once

namespace CLI {
class App;
}

namespace stipple {

struct GigeServerOptions;

/// What a served camera shall do wrong: `--fault-...`, for tests of clients.
void add_fault_arguments(CLI::App& command, GigeServerOptions& options);

}  // namespace stipple
