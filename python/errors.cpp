#include "python/errors.h"

#include <fmt/format.h>
#include <pybind11/stl/filesystem.h>
#include <unistd.h>

#include <cerrno>
#include <string>

#include "core/text.h"
#include "io/partial_output.h"
#include "python/bindings.h"

namespace stipple::python {
namespace fs = std::filesystem;
namespace {

PyObject* class_of(int number) {
    if (number == ENOENT) return PyExc_FileNotFoundError;
    if (number == EACCES) return PyExc_PermissionError;
    if (number == EISDIR) return PyExc_IsADirectoryError;
    return number == EEXIST ? PyExc_FileExistsError : PyExc_OSError;
}

}  // namespace

std::string short_text(const py::object& value) {
    constexpr py::ssize_t kMaxLetters = 80;
    const py::str text = py::repr(value);
    const py::object begin = text[py::slice(0, kMaxLetters, 1)];
    const bool is_whole = begin.equal(text);
    return std::string(py::str(begin)) + (is_whole ? "" : " ...");
}

std::string as_argument(const Parameter& parameter) {
    const auto& [name, value] = parameter;
    if (const auto dot = name.find('.'); dot != std::string::npos)
        return fmt::format("{} setting {}{}", name.substr(0, dot), name.substr(dot + 1),
                           value.empty() ? "" : "=" + value);
    if (name == "max_memory")
        return value.empty() ? "MaxMemory" : fmt::format("stipple.MaxMemory(\"{}\")", value);
    if (value.empty()) return name;
    if (value == "true") return name + "=True";
    const std::string_view quote = parsed_number<double>(value) ? "" : "\"";
    return fmt::format("{}={}{}{}", name, quote, value, quote);
}

std::string in_python(const Message& message) {
    return message.text(as_argument);
}

namespace {

/// Names of files need not be UTF-8, so they are decoded as Python decodes them.
void set_error(PyObject* kind, const std::string& message) {
    const py::object text =
        py::reinterpret_steal<py::object>(PyUnicode_DecodeFSDefault(message.c_str()));
    if (text) PyErr_SetObject(kind, text.ptr());
}

void translate(std::exception_ptr thrown) {
    try {
        if (thrown) std::rethrow_exception(std::move(thrown));
    } catch (const FileError& error) {
        set_error(class_of(error.number()), error.what());
    } catch (const InputError& error) {
        set_error(PyExc_ValueError, in_python(error.message()));
    } catch (const DeviceError& error) {
        set_error(PyExc_OSError, in_python(error.message()));
    } catch (const fs::filesystem_error& error) {
        set_error(class_of(error.code().value()), error.what());
    }
}

}  // namespace

fs::path path_in(const py::object& value, const char* argument) {
    try {
        return value.cast<fs::path>();
    } catch (const py::cast_error&) {
        throw py::type_error(fmt::format("{}: {} is neither a text nor a path of a file", argument,
                                         short_text(value)));
    }
}

std::uint64_t whole_in(const py::object& value, const char* argument) {
    const auto index = py::reinterpret_steal<py::object>(PyNumber_Index(value.ptr()));
    if (!index) {
        PyErr_Clear();
        throw py::type_error(
            fmt::format("{}: {} is not a whole number", argument, short_text(value)));
    }
    const unsigned long long number = PyLong_AsUnsignedLongLong(index.ptr());
    if (PyErr_Occurred() != nullptr) {
        PyErr_Clear();
        throw InputError(argument, fmt::format("{} is outside 0..2^64 - 1", short_text(index)));
    }
    return number;
}

std::pair<std::uint64_t, std::uint64_t> size_in(const py::object& value, const char* argument) {
    const bool is_list = PySequence_Check(value.ptr()) != 0 && !py::isinstance<py::str>(value);
    if (!is_list || py::len(value) != 2)
        throw py::type_error(
            fmt::format("{}: {} is not (rows, columns)", argument, short_text(value)));
    const auto side = [&](py::size_t i) {
        return whole_in(py::reinterpret_borrow<py::sequence>(value)[i], argument);
    };
    return {side(0), side(1)};
}

void check_name(const fs::path& file, const OutputName& name) {
    if (const std::string problem = name_problem(file, name); !problem.empty())
        throw InputError(file.string(), problem);
}

void check_readable(const fs::path& file, const InputError& error) {
    if (::access(file.c_str(), R_OK) != 0) throw FileError(errno, in_python(error.message()));
    std::error_code unknown;
    if (fs::is_directory(file, unknown)) throw FileError(EISDIR, in_python(error.message()));
}

void check_creatable(const fs::path& file, const InputError& error) {
    std::error_code unknown;
    if (fs::exists(file, unknown)) throw FileError(EEXIST, in_python(error.message()));
    if (!fs::exists(folder_of(file), unknown)) throw FileError(ENOENT, in_python(error.message()));
}

void bind_errors() {
    py::register_exception_translator(translate);
}

}  // namespace stipple::python
