#include "apps/arguments/page_server.h"

#include "apps/arguments/common_options.h"

namespace stipple {

void add_page_server_options(Command& command, PageServerOptions& options) {
    command.add_option("--port", options.port, "TCP port of the page")
        .default_text("a free one")
        .check(whole_check(1, 65535))
        .type_name("N");
    command
        .add_option("--address", options.address,
                    "address of the network interface; 0.0.0.0 serves every network, unencrypted")
        .shows_default()
        .type_name("IP");
}

}  // namespace stipple
