#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "core/error.h"
#include "study/metrics/emva1288/series.h"

/// Input: a descriptor. What is accepted keeps its limits, and reads the same when written out.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace stipple;
    try {
        const auto series =
            emva1288::parse_series({reinterpret_cast<const char*>(data), size}, "fuzz");
        if (series.bits < 1 || series.bits > 16 || series.groups.empty()) std::abort();
        for (const auto& group : series.groups)
            if (group.files.size() < 2 || !(group.photons >= 0)) std::abort();
        const std::string text = series_text(series);
        if (series_text(emva1288::parse_series(text, "fuzz")) != text) std::abort();
    } catch (const InputError&) {
        return 0;
    }
    return 0;
}
