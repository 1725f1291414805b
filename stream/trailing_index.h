#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "stream/file_window.h"
#include "stream/framing.h"
#include "stream/slot_index.h"

namespace stipple {

/// Slots in the recording, by the index that the end marker of a file points to. Nothing if there
/// is none, if it is damaged, or if it is not where the marker says (bytes of the file are missing
/// then, and no offset is right).
[[nodiscard]] std::optional<std::int64_t> slots_by_index(const FileWindow& file,
                                                         const Framing& framing);

/// The first entry of an index that does not name the first packet of its slot, in words. Nothing
/// is found in a pipe.
[[nodiscard]] std::optional<std::string> wrong_entry(const std::vector<IndexEntry>& entries,
                                                     const FileWindow& file,
                                                     const Framing& framing);

}  // namespace stipple
