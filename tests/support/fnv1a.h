#pragma once

#include <cstdint>

namespace stipple {

/// The 64-bit FNV-1a hash of numbers, as their bytes from the lowest: what golden files hold.
class Fnv1a {
  public:
    void add(std::uint64_t value, int bytes) {
        for (int i = 0; i < bytes; ++i, value >>= 8U)
            hash_ = (hash_ ^ (value & 0xFFU)) * 0x100000001B3U;
    }
    [[nodiscard]] std::uint64_t hash() const { return hash_; }

  private:
    std::uint64_t hash_ = 0xCBF29CE484222325U;
};

}  // namespace stipple
