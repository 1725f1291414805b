#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/config.h"
#include "core/error.h"
#include "tests/support/memory_file.h"

namespace stipple {
namespace {

constexpr std::array<std::string_view, 2> kModes{"paper", "physical"};

void read_all_keys(Config& config) {
    static_cast<void>(config.number({"gain", {0, 100}}, 1));
    static_cast<void>(config.integer({"adc.bit_depth", {1, 16}}, 8));
    static_cast<void>(config.boolean({"adc.dither"}, false));
    static_cast<void>(config.choice({.name = "mode", .choices = kModes}, 0));
    static_cast<void>(config.integers({"exposure_slots", {1, 64}}, {1}));
    static_cast<void>(config.numbers({"row_noise_e", {0, 100}}, {}));
    static_cast<void>(config.text({"name"}, ""));
    config.reject_unknown_keys();
}

}  // namespace
}  // namespace stipple

/// Input: a TOML file; after a zero byte an override, and so on.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    std::vector<std::string> parts(1);
    for (std::size_t i = 0; i < size; ++i)
        if (data[i] == 0)
            parts.emplace_back();
        else
            parts.back() += static_cast<char>(data[i]);
    const stipple::MemoryFile file(parts.front());
    parts.erase(parts.begin());
    try {
        stipple::Config config(file.path(), parts);
        stipple::read_all_keys(config);
    } catch (const stipple::InputError&) {
    }
    return 0;
}
