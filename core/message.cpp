#include "core/message.h"

namespace stipple {

std::string in_cpp(const Parameter& parameter) {
    return parameter.value.empty() ? parameter.name : parameter.name + " = " + parameter.value;
}

Message::Message(std::string text) {
    if (!text.empty()) pieces_.emplace_back(std::move(text));
}

Message& Message::operator+=(const Message& other) {
    for (const auto& piece : std::vector(other.pieces_)) {  // `other` may be this one
        const auto* const text = std::get_if<std::string>(&piece);
        auto* const last = pieces_.empty() ? nullptr : std::get_if<std::string>(&pieces_.back());
        if (text != nullptr && last != nullptr)
            *last += *text;
        else
            pieces_.push_back(piece);
    }
    return *this;
}

std::string Message::text(Wording wording) const {
    std::string text;
    for (const auto& piece : pieces_) {
        const auto* const parameter = std::get_if<Parameter>(&piece);
        text += parameter == nullptr ? std::get<std::string>(piece) : wording(*parameter);
    }
    return text;
}

std::vector<Parameter> Message::parameters() const {
    std::vector<Parameter> found;
    for (const auto& piece : pieces_)
        if (const auto* const parameter = std::get_if<Parameter>(&piece))
            found.push_back(*parameter);
    return found;
}

}  // namespace stipple
