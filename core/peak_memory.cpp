#include "core/peak_memory.h"

#include <malloc.h>

#include <fstream>
#include <string>
#include <string_view>

namespace stipple {
namespace {

/// A line of /proc/self/status: VmRSS is what lies in RAM, VmHWM the most that ever did.
std::optional<std::uint64_t> status_bytes(std::string_view key) {
    std::ifstream status("/proc/self/status");
    for (std::string word; status >> word;) {
        if (word != key) continue;
        std::uint64_t kilobytes = 0;
        if (status >> kilobytes) return kilobytes * 1024;
    }
    return std::nullopt;
}

}  // namespace

PeakMemory::PeakMemory() {
    malloc_trim(0);
    // 5 resets the mark (proc(5)).
    if (std::ofstream("/proc/self/clear_refs") << "5" << std::flush)
        before_ = status_bytes("VmRSS:");
}

std::optional<std::uint64_t> PeakMemory::bytes() const {
    const auto most = status_bytes("VmHWM:");
    if (!before_ || !most) return std::nullopt;
    return *most > *before_ ? *most - *before_ : 0;
}

}  // namespace stipple
