#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>

#include "apps/arguments/run_options.h"
#include "io/pending_output.h"

namespace stipple {

/// Takes the figures of a run for programs. Opened before the work, so that a name that cannot be
/// used is refused at once.
class JsonFile {
  public:
    /// \throws InputError as PendingOutput.
    explicit JsonFile(const RunOptions& run);
    /// Writes `figures`, if the user wants them, with the warnings so far as `warnings`. Infinite
    /// values and NaN become null. \throws DeviceError.
    void write(nlohmann::ordered_json figures);

  private:
    bool to_stdout_;
    std::optional<PendingOutput> output_;
};

}  // namespace stipple
