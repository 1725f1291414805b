#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/message.h"
#include "io/footage_reader.h"
#include "io/image.h"

namespace stipple {

/// The transfer function by which a source is read: that of `options`, or with kAuto the one that
/// the source declares. Images that declare none are sRGB if they look gamma-coded, else linear.
/// \throws InputError at `name` if a video declares none, or one that is not known.
[[nodiscard]] Transfer transfer_of(const FootageOptions& options, const SourceInfo& traits,
                                   bool is_video, const std::string& name);

/// Effects of `options` on numbers of this kind that users may not expect; each begins with `name`.
[[nodiscard]] std::vector<Message> reading_warnings(const SourceInfo& traits,
                                                    const FootageOptions& options,
                                                    const std::string& name);

/// A warning if frames are `apart` unequally and `options` do not heed it; else empty.
[[nodiscard]] Message unequal_times_warning(const std::string& apart, const FootageOptions& options,
                                            const std::string& name);

/// A warning if the mean of `light` is far above 1.0, as with digital numbers stored in floating
/// point; else empty.
[[nodiscard]] std::string brightness_warning(std::span<const float> light,
                                             const std::string& where);

}  // namespace stipple
