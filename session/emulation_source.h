#pragma once

#include <functional>
#include <optional>
#include <string>

#include "capture/recording/read_ahead.h"
#include "capture/recording/resampled_footage.h"
#include "io/frame_resampler.h"
#include "readout/provenance.h"

namespace stipple {

/// What a sensor films: footage or a recording, how it is read, and how its frames become slots.
struct EmulationSource {
    std::string footage;
    FootageOptions reading = {};
    std::optional<Resampling> resampling = {};  ///< none: each frame is a slot

    /// Passes the warnings of the reader to `warn`. \throws InputError as ReadAhead.
    [[nodiscard]] ReadAhead open(std::function<void(const Message&)> warn) const;
    /// What `open` gave as slots of a sensor. \throws InputError as ResampledFootage.
    [[nodiscard]] ResampledFootage slots_of(ReadAhead& frames, double slot_us) const;
    /// Reads the files of the footage; `check` is called before each MiB, and may throw to give up.
    /// \throws InputError.
    [[nodiscard]] FootageOrigin origin(const std::function<void()>& check) const;
};

/// \throws InputError that the footage has no slot.
[[noreturn]] void refuse_short_footage(const std::string& footage);

}  // namespace stipple
