#include "capture/payload_hash.h"

#define XXH_INLINE_ALL
#include <xxhash.h>

namespace stipple {

std::uint64_t payload_hash(std::span<const std::uint8_t> payload) {
    return XXH3_64bits(payload.data(), payload.size());
}

}  // namespace stipple
