#include <cstdint>
#include <cstdlib>
#include <string>

#include "readout/provenance.h"
#include "stream/plain_text.h"

/// Input: the provenance text of a stream. The command made of it is one line of plain text.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace stipple;
    const std::string text(data, data + size);
    if (!is_plain_text(text, true)) return 0;  // which no header holds
    if (!is_plain_text(command_of(text), false)) std::abort();
    static_cast<void>(timing_settings(text));
    static_cast<void>(chip_of(text));
    return 0;
}
