#pragma once

/// In a source: defines an object with the name of a C function of a library that is loaded when
/// the function is first called, in place of the linked function. It converts to the function and
/// is called in the same way. `resolve(const char*)` gives the address of the function of a name.
// NOLINTBEGIN(bugprone-macro-parentheses): these are names, no values
#define STIPPLE_LAZY_FROM(resolve, name)                                                   \
    const struct {                                                                         \
        using Function = decltype(::name);                                                 \
        operator Function*() const { return reinterpret_cast<Function*>(resolve(#name)); } \
    } name {                                                                               \
    }
// NOLINTEND(bugprone-macro-parentheses)
