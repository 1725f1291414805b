#include "apps/arguments/common_options.h"

#include <fmt/format.h>

#include <charconv>
#include <optional>
#include <system_error>
#include <type_traits>

namespace stipple {
namespace {

template <typename Number>
std::optional<Number> number_of(const std::string& text, bool* too_large = nullptr) {
    Number value{};
    const char* const end = text.data() + text.size();
    const auto parsed = std::from_chars(text.data(), end, value);
    if (too_large != nullptr) *too_large = parsed.ec == std::errc::result_out_of_range;
    if (parsed.ec != std::errc() || parsed.ptr != end) return {};
    return value;
}

template <typename Number>
ValueCheck range_check(std::string kind, Number min, Number max) {
    return [=](const std::string& text) -> std::string {
        bool too_large = false;
        const auto value = number_of<Number>(text, &too_large);
        if (value && *value >= min && *value <= max) return {};
        if (too_large && std::is_integral_v<Number>)
            return fmt::format("\"{}\" is too large; {} is the most", text, max);
        if (max == std::numeric_limits<Number>::max())
            return fmt::format("\"{}\" is not {} of {} or more", text, kind, min);
        return fmt::format("\"{}\" is not {} from {} to {}", text, kind, min, max);
    };
}

}  // namespace

ValueCheck number_check(double min, double max) {
    return range_check("a number", min, max);
}

ValueCheck positive_check() {
    return [](const std::string& text) -> std::string {
        constexpr auto kMin = static_cast<double>(std::numeric_limits<float>::min());
        constexpr auto kMax = static_cast<double>(std::numeric_limits<float>::max());
        const auto value = number_of<double>(text);
        if (value && *value >= kMin && *value <= kMax) return {};
        if (value && *value > 0)
            return fmt::format("{} is outside {:.2g}..{:.2g}", text, kMin, kMax);
        return fmt::format("\"{}\" is not a number above 0", text);
    };
}

ValueCheck whole_check(std::uint64_t min, std::uint64_t max) {
    return range_check("a whole number", min, max);
}

ValueCheck frames_check() {
    return whole_check(1, std::uint64_t{1} << 53U);
}

void parse_size(const std::string& option, const std::string& text, SideRange sides,
                FrameShape& shape) {
    const char* const end = text.data() + text.size();
    const auto cols = std::from_chars(text.data(), end, shape.cols);
    const bool crossed = cols.ptr != end && *cols.ptr == 'x';
    const auto rows = std::from_chars(crossed ? cols.ptr + 1 : end, end, shape.rows);
    if (cols.ec != std::errc() || rows.ec != std::errc() || rows.ptr != end)
        throw UsageError(option, "\"" + text + "\" is not a size like 640x480");
    for (const int side : {shape.cols, shape.rows})
        if (side < sides.min || side > sides.max)
            throw UsageError(
                option, fmt::format("{}: sides are {} to {} pixels", text, sides.min, sides.max));
}

CommandOption add_size(Command& command, const std::string& name, FrameShape& shape,
                       SideRange sides, const std::string& text) {
    const auto take = [option = name.substr(0, name.find(',')), sides,
                       &shape](const std::string& size) { parse_size(option, size, sides, shape); };
    CommandOption option = command.add_parsed(name, take, text).type_name("WxH");
    return shape.pixels() == 0 ? option
                               : option.default_text(fmt::format("{}x{}", shape.cols, shape.rows));
}

CommandOption add_output(Command& command, std::string& output, const std::string& text,
                         const OutputName& name, const std::string& type_name) {
    return command.add_option("-o,--output", output, text)
        .type_name(type_name)
        .required()
        .output(name);
}

CommandOption add_seed(Command& command, std::uint64_t& seed, const std::string& text) {
    return command.add_option("--seed", seed, text)
        .shows_default()
        .check(whole_check(0))
        .type_name("S");
}

}  // namespace stipple
