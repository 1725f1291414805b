#include "python/own_decoder.h"

#include <fmt/format.h>
#include <pybind11/numpy.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>
#include <utility>

#include "core/error.h"
#include "python/bindings.h"
#include "python/with_gil.h"

namespace stipple::python {
namespace {

std::string type_name(const py::handle& value) {
    return py::str(py::type::handle_of(value).attr("__name__"));
}

/// (slot, row, col) or (slot, row, col, plane).
FluxVideo video_of(const py::object& result, const std::string& decoder) {
    const auto array = py::array::ensure(result);
    const bool is_video = array && array.dtype().kind() == 'f' &&
                          (array.ndim() == 3 || array.ndim() == 4) &&
                          !py::module_::import("numpy.ma").attr("is_masked")(result).cast<bool>();
    if (!is_video) {
        const std::string given = array ? fmt::format("an array of shape {} and dtype {}",
                                                      std::string(py::str(array.attr("shape"))),
                                                      std::string(py::str(array.dtype())))
                                        : type_name(result);
        throw DecoderFault(
            fmt::format("decoder \"{}\": gave {}, not an array (slot, row, col) of "
                        "floating-point light without masks",
                        decoder, given));
    }
    const auto side = [&](int axis) { return static_cast<int>(array.shape(axis)); };
    FluxVideo video(side(0), {side(1), side(2), array.ndim() == 4 ? side(3) : 1});
    const py::array_t<float, py::array::c_style | py::array::forcecast> planar(
        array.ndim() == 4 ? py::array(array.attr("transpose")(0, 3, 1, 2)) : array);
    std::copy_n(planar.data(), planar.size(), video.data().begin());
    return video;
}

}  // namespace

DecoderRaised::DecoderRaised(const std::string& decoder, py::error_already_set& raised)
    : decoder_(decoder), raised_(raised) {}  // NOLINT(bugprone-throw-keyword-missing): a member

void DecoderRaised::raise(const std::string& where) {
    if (!raised_.matches(PyExc_Exception)) throw raised_;
    const std::string text = fmt::format("decoder \"{}\"{}: raised {}: {}", decoder_, where,
                                         std::string(py::str(raised_.type().attr("__name__"))),
                                         std::string(py::str(raised_.value())));
    py::raise_from(raised_, PyExc_RuntimeError, text.c_str());
    throw py::error_already_set();
}

OwnDecoder own_decoder(const std::string& name, const std::string& version,
                       const py::object& decode) {
    const auto function = with_gil(new py::object(decode));
    const auto call = [function, name](const std::filesystem::path& stream,
                                       const std::string& options) {
        const py::gil_scoped_acquire gil;
        try {
            return video_of((*function)(stream, options), name);
        } catch (py::error_already_set& raised) {
            if (raised.matches(PyExc_NotImplementedError))
                throw InputError(fmt::format("decoder \"{}\"", name),
                                 std::string(py::str(raised.value())));
            throw DecoderRaised(name, raised);
        }
    };
    return {name, call, version};
}

}  // namespace stipple::python
