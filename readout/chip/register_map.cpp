#include "readout/chip/register_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <vector>

#include "core/error.h"
#include "core/text.h"
#include "readout/chip_registers.h"

namespace stipple {
namespace {

using Access = ChipRegister::Access;
using Lock = ChipRegister::Lock;

constexpr Access access_of(std::string_view word) {
    return word == "read"    ? Access::kRead
           : word == "write" ? Access::kWrite
           : word == "flags" ? Access::kFlags
                             : Access::kBoth;
}

constexpr Lock lock_of(std::string_view word) {
    return word == "run" ? Lock::kRun : word == "bank" ? Lock::kBank : Lock::kNone;
}

constexpr ChipRegister kRegisters[] = {
#define STIPPLE_REGISTER(name, address, count, bits, reset, access, lock) \
    {#name, address, count, bits, reset, access_of(#access), lock_of(#lock)},
    STIPPLE_REGISTERS(STIPPLE_REGISTER)
#undef STIPPLE_REGISTER
};

std::optional<std::uint32_t> number_of(std::string_view text) {
    const bool is_hex = text.starts_with("0x") || text.starts_with("0X");
    return is_hex ? parsed_number<std::uint32_t>(text.substr(2), 16)
                  : parsed_number<std::uint32_t>(text);
}

/// The register of "NAME[i]"; a name alone is its first one.
std::optional<std::uint32_t> named(std::string_view text) {
    const std::size_t bracket = text.find('[');
    const auto* const found =
        std::ranges::find(kRegisters, text.substr(0, bracket), &ChipRegister::name);
    if (found == std::end(kRegisters)) return std::nullopt;
    if (bracket == std::string_view::npos) return found->address;
    const std::string_view rest = text.substr(bracket + 1);
    if (!rest.ends_with(']')) return std::nullopt;
    const auto place = parsed_number<std::uint32_t>(rest.substr(0, rest.size() - 1));
    if (!place || *place >= found->count)
        throw InputError(text,
                         fmt::format("{} has the places 0 to {}", found->name, found->count - 1));
    return found->address + 4 * *place;
}

}  // namespace

std::span<const ChipRegister> chip_registers() {
    return kRegisters;
}

const ChipRegister* register_at(std::uint32_t address) {
    const auto* const found = std::ranges::find_if(kRegisters, [&](const ChipRegister& it) {
        return address >= it.address && address < it.address + 4 * it.count && address % 4 == 0;
    });
    return found == std::end(kRegisters) ? nullptr : found;
}

std::string register_name(std::uint32_t address) {
    const ChipRegister* const found = register_at(address);
    if (found == nullptr) return fmt::format("0x{:03X}", address);
    return found->count == 1 ? std::string(found->name)
                             : fmt::format("{}[{}]", found->name, (address - found->address) / 4);
}

std::uint32_t register_address(std::string_view text) {
    if (const auto number = number_of(text)) return *number;
    if (const auto address = named(text)) return *address;
    std::vector<std::string> names;
    for (const ChipRegister& it : kRegisters) names.emplace_back(it.name);
    throw InputError(text, "is not a register: " + suggestion(text, names));
}

std::uint32_t register_value(std::string_view text) {
    const auto value = number_of(text);
    if (!value) throw InputError(text, "is not a number of 32 bits, such as 68 or 0x44");
    return *value;
}

}  // namespace stipple
