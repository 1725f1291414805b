#pragma once

#include "apps/arguments/command_line.h"
#include "view/page_server.h"

namespace stipple {

/// `--port` and `--address` of a page.
void add_page_server_options(Command& command, PageServerOptions& options);

}  // namespace stipple
