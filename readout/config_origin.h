#pragma once

#include <string>
#include <vector>

namespace stipple {

/// The configuration file of a sensor or schedule at the time it was read, for the provenance of a
/// stream.
struct ConfigOrigin {
    std::string name;                        ///< name or file, without folders
    std::vector<std::string> settings = {};  ///< "key=value", laid over the file
    std::string keys = {};  ///< of file and settings together: lines of TOML; may be left out
};

}  // namespace stipple
