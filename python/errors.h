#pragma once

#include <pybind11/pytypes.h>

#include <cstdint>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <utility>

#include "core/error.h"
#include "io/output_names.h"

/// Errors in Python: InputError is a ValueError, DeviceError an OSError, both with their texts.
/// What is wrong with a file before its content counts is an OSError too, of the class that `open`
/// raises.
namespace stipple::python {

/// A parameter as an argument: "fill_gaps=True".
[[nodiscard]] std::string as_argument(const Parameter& parameter);

/// A message with parameters as arguments.
[[nodiscard]] std::string in_python(const Message& message);

/// How Python shows a value, of values that are long the begin.
[[nodiscard]] std::string short_text(const pybind11::object& value);

/// \throws TypeError naming `argument` if it is neither a text nor a path, or holds a NUL.
[[nodiscard]] std::filesystem::path path_in(const pybind11::object& value, const char* argument);

/// The whole number of an argument. \throws TypeError naming `argument` if it is none, InputError
/// if it is below 0 or above 2^64 - 1.
[[nodiscard]] std::uint64_t whole_in(const pybind11::object& value, const char* argument);

/// The same of (rows, columns).
[[nodiscard]] std::pair<std::uint64_t, std::uint64_t> size_in(const pybind11::object& value,
                                                              const char* argument);

/// A file that cannot be opened or created.
class FileError : public std::runtime_error {
  public:
    /// `number` as errno.
    FileError(int number, const std::string& text) : std::runtime_error(text), number_(number) {}
    [[nodiscard]] int number() const { return number_; }

  private:
    int number_;
};

/// \throws FileError with the text of `error` if `file` is not there, may not be read, or is a
/// folder.
void check_readable(const std::filesystem::path& file, const InputError& error);

/// \throws FileError with the text of `error` if `file` is there already, or its folder is not.
void check_creatable(const std::filesystem::path& file, const InputError& error);

/// \throws InputError naming `file` and its problem as a name of `name`, as `name_problem`.
void check_name(const std::filesystem::path& file, const OutputName& name);

/// The value of `read()`, which reads `file`. \throws FileError where it cannot be opened.
template <typename Read>
auto reading(const std::filesystem::path& file, Read&& read) {
    try {
        return std::forward<Read>(read)();
    } catch (const InputError& error) {
        check_readable(file, error);
        throw;
    }
}

/// The value of `create()`, which creates `file`. \throws FileError where that cannot be.
template <typename Create>
auto creating(const std::filesystem::path& file, Create&& create) {
    try {
        return std::forward<Create>(create)();
    } catch (const InputError& error) {
        check_creatable(file, error);
        throw;
    }
}

}  // namespace stipple::python
