#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace stipple {

/// A register of the chip, or several of one name (docs/chip_registers.md).
struct ChipRegister {
    enum class Access : std::uint8_t { kRead, kWrite, kBoth, kFlags };
    enum class Lock : std::uint8_t { kNone, kRun, kBank };

    std::string_view name;
    std::uint32_t address = 0;
    std::uint32_t count = 1;
    int bits = 32;
    std::uint32_t reset = 0;
    Access access = Access::kBoth;
    Lock lock = Lock::kNone;
};

/// All of them, by address.
[[nodiscard]] std::span<const ChipRegister> chip_registers();

/// The one at an address; null if there is none.
[[nodiscard]] const ChipRegister* register_at(std::uint32_t address);

/// "STATUS", or "BANK_PERIOD[1]" if there are several.
[[nodiscard]] std::string register_name(std::uint32_t address);

/// The address that a text means: a name as of `register_name`, a number, or a hexadecimal number
/// such as 0x044. \throws InputError if there is no such name or the text is no 32-bit number.
[[nodiscard]] std::uint32_t register_address(std::string_view text);

/// The number that a text means: 68 or 0x44. \throws InputError unless it is 0 to 2^32 - 1.
[[nodiscard]] std::uint32_t register_value(std::string_view text);

}  // namespace stipple
