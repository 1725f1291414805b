#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "capture/camera.h"
#include "capture/network.h"

/// Input: what a camera or a user gives as a number or an address. What is taken for one reads the
/// same when written out.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace stipple;
    const std::string text(data, data + size);
    const auto integer = integer_setting(text);
    if (integer && integer_setting(std::to_string(*integer)) != integer) std::abort();
    const auto number = number_setting(text);
    if (number && !std::isfinite(*number)) std::abort();
    const auto address = parse_ipv4(text);
    if (address && ipv4_text(*address) != text) std::abort();
    return 0;
}
