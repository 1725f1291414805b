#include "python/errors.h"

#include <unistd.h>

#include <cerrno>
#include <regex>
#include <string>
#include <utility>

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

std::string in_python(const std::string& message) {
    const std::pair<const char*, const char*> arguments[] = {
        {"--set (sensor|schedule|decoder|camera)[.]", "$1 setting "},
        {"--force", "force=True"},
        {"--fill-gaps", "fill_gaps=True"},
        {"--overrun drop", "overrun=\"drop\""},
        {"--max-memory ([0-9.]+[KMGT])", "stipple.MaxMemory(\"$1\")"},
        {"--max-memory", "MaxMemory"}};
    std::string text = message;
    for (const auto& [option, argument] : arguments)
        text = std::regex_replace(text, std::regex(option), argument);
    return text;
}

namespace {

void translate(std::exception_ptr thrown) {
    try {
        if (thrown) std::rethrow_exception(std::move(thrown));
    } catch (const FileError& error) {
        PyErr_SetString(class_of(error.number()), in_python(error.what()).c_str());
    } catch (const InputError& error) {
        PyErr_SetString(PyExc_ValueError, in_python(error.what()).c_str());
    } catch (const DeviceError& error) {
        PyErr_SetString(PyExc_OSError, in_python(error.what()).c_str());
    } catch (const fs::filesystem_error& error) {
        PyErr_SetString(class_of(error.code().value()), error.what());
    }
}

}  // namespace

void check_readable(const fs::path& file, const InputError& error) {
    if (::access(file.c_str(), R_OK) != 0) throw FileError(errno, error.what());
    std::error_code unknown;
    if (fs::is_directory(file, unknown)) throw FileError(EISDIR, error.what());
}

void check_creatable(const fs::path& file, const InputError& error) {
    std::error_code unknown;
    if (fs::exists(file, unknown)) throw FileError(EEXIST, error.what());
    if (!fs::exists(folder_of(file), unknown)) throw FileError(ENOENT, error.what());
}

void bind_errors() {
    py::register_exception_translator(translate);
}

}  // namespace stipple::python
