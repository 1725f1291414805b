#pragma once

#include <string>

#include "core/error.h"

namespace stipple {

/// A check that passes the names that `from_name` does not throw for, so that the list
/// of names stays in one place.
template <typename FromName>
[[nodiscard]] auto name_check(FromName from_name) {
    return [from_name](const std::string& name) -> std::string {
        try {
            static_cast<void>(from_name(name));
        } catch (const InputError& e) {
            return e.what();
        }
        return {};
    };
}

}  // namespace stipple
