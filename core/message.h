#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace stipple {

/// What a user can set, as a message names it: an option ("fill_gaps") or a key ("sensor.slot_us").
/// Each interface has its own wording for it: `--fill-gaps`, `fill_gaps=True`, `fill_gaps = true`.
struct Parameter {
    std::string name;        ///< that of the member; a key has its section
    std::string value = {};  ///< the one to give, "true" for a flag; empty if it is only named

    bool operator==(const Parameter&) const = default;
};

/// In C++: "fill_gaps = true".
[[nodiscard]] std::string in_cpp(const Parameter& parameter);

/// A text for people, with the parameters that it names:
/// `"slot 3 is missing; to decode it too, give " + Parameter{"fill_gaps", "true"}`.
class Message {
  public:
    using Wording = std::string (*)(const Parameter&);

    Message() = default;
    Message(std::string text);                                                    // NOLINT
    Message(std::string_view text) : Message(std::string(text)) {}                // NOLINT
    Message(const char* text) : Message(std::string(text)) {}                     // NOLINT
    Message(Parameter parameter) { pieces_.emplace_back(std::move(parameter)); }  // NOLINT

    Message& operator+=(const Message& other);
    [[nodiscard]] bool empty() const { return pieces_.empty(); }
    [[nodiscard]] std::string text(Wording wording = in_cpp) const;
    [[nodiscard]] std::vector<Parameter> parameters() const;
    bool operator==(const Message&) const = default;

  private:
    std::vector<std::variant<std::string, Parameter>> pieces_;  ///< no empty text, no two in a row
};

[[nodiscard]] inline Message operator+(Message first, const Message& second) {
    first += second;
    return first;
}

/// Max entries of a list of faults in reports and JSON: damaged places, gaps, late slots. Further
/// faults are only counted, so that a bad file of any size is reported in bounded memory.
inline constexpr std::size_t kMaxListedFaults = 1000;

/// Max entries of such a list in a text.
inline constexpr std::size_t kMaxShownFaults = 10;

}  // namespace stipple
