#pragma once

#include <pybind11/pybind11.h>

#include <exception>
#include <string>

#include "study/decoders/own_decoder.h"

namespace stipple::python {

/// What a decoder of Python has raised.
class DecoderRaised : public std::exception {
  public:
    /// With the GIL.
    DecoderRaised(const std::string& decoder, pybind11::error_already_set& raised);
    /// Raises RuntimeError from it, with its text and `where`; what is no Exception, such as
    /// KeyboardInterrupt, as it is. With the GIL.
    [[noreturn]] void raise(const std::string& where);

  private:
    std::string decoder_;
    pybind11::error_already_set raised_;
};

/// decode(path of a stream, options as lines of TOML) as a decoder, which throws DecoderFault,
/// DecoderRaised and, where Python raises NotImplementedError, InputError. With the GIL; the
/// decoder takes it by itself.
[[nodiscard]] OwnDecoder own_decoder(const std::string& name, const std::string& version,
                                     const pybind11::object& decode);

}  // namespace stipple::python
