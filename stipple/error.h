#pragma once

/// What functions of Stipple throw. Both kinds are std::runtime_error, with a text of what is wrong
/// where, and what to do:
///
///     try {
///         stipple::StreamReader stream("nosuch.stipple");
///     } catch (const stipple::InputError& error) {  // a file, a key or an option of yours
///         std::cerr << error.what() << "\n";
///     } catch (const stipple::DeviceError& error) {  // a disk or a camera
///         std::cerr << error.what() << "\n";
///     }
#include "core/error.h"
