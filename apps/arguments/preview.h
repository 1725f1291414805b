#pragma once

#include <optional>
#include <string>

#include "apps/arguments/command_line.h"
#include "decoder/preview.h"

namespace stipple {

/// The preview of `stipple capture live`.
struct PreviewArguments {
    std::string file;                ///< .png or .npy; empty: none
    std::string method = "live";     ///< or "naive", "fast"
    std::optional<FrameShape> size;  ///< rows and columns of the middle of the frame
};

/// `--preview`, `--preview-method` and `--preview-size`.
void add_preview_arguments(Command& command, PreviewArguments& arguments);

[[nodiscard]] PreviewOptions preview_options(const PreviewArguments& arguments);

/// \throws InputError if the preview cannot be written: its folder is missing, or a file of its
/// name exists and not `force`.
void check_preview_file(const PreviewArguments& arguments, bool force);

}  // namespace stipple
