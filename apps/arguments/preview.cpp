#include "apps/arguments/preview.h"

#include "apps/arguments/common_options.h"
#include "core/geometry.h"
#include "io/output_names.h"
#include "io/pending_output.h"

namespace stipple {

void add_preview_arguments(Command& command, PreviewArguments& arguments) {
    static constexpr SideRange kSides{8, kMaxFrameSide};
    command
        .add_option("--preview", arguments.file,
                    "keep a decoded image of the newest slots: .png (tone-mapped, saturated "
                    "pixels red) or .npy (linear light)")
        .type_name("FILE")
        .output(kPreviewName);
    command
        .add_option(
            "--preview-method", arguments.method,
            "decoding method of the preview: naive, live, or fast, which is better and takes "
            "seconds")
        .shows_default()
        .one_of({"fast", "live", "naive"})
        .type_name("NAME");
    command
        .add_parsed(
            "--preview-size",
            [&arguments](const std::string& text) {
                parse_size("--preview-size", text, kSides, arguments.size.emplace());
            },
            "part of the frame in the preview, from its middle")
        .default_text("as much as is decoded within some seconds")
        .type_name("WxH");
}

PreviewOptions preview_options(const PreviewArguments& arguments) {
    return {.method = decode_method_from_name(arguments.method), .size = arguments.size};
}

void check_preview_file(const PreviewArguments& arguments, bool force) {
    const PendingOutput probe(arguments.file, force);
}

}  // namespace stipple
