#include "apps/arguments/preview.h"

#include "apps/arguments/checks.h"
#include "apps/arguments/output_names.h"
#include "io/pending_output.h"

namespace stipple {

void add_preview_arguments(Command& command, PreviewArguments& arguments) {
    constexpr int kMinSide = 8;
    constexpr int kMaxSide = 65536;
    command
        .add_option("--preview", arguments.file,
                    "image of what the decoder makes of the newest slots, replaced again and "
                    "again: .png to look at, .npy linear light")
        .type_name("FILE")
        .output(kPreviewName);
    command
        .add_option("--preview-method", arguments.method,
                    "naive: at once, noisier; fast: as it will be decoded, in seconds (naive)")
        .one_of({"fast", "naive"})
        .type_name("NAME");
    command
        .add_parsed(
            "--preview-size",
            [&arguments](const std::string& text) {
                parse_size("--preview-size", text, kMinSide, kMaxSide, arguments.size.emplace());
            },
            "so much of the middle of the frame (all, or what is decoded in some seconds)")
        .type_name("WxH");
}

PreviewOptions preview_options(const PreviewArguments& arguments) {
    return {.method = decode_method_from_name(arguments.method), .size = arguments.size};
}

void check_preview_file(const PreviewArguments& arguments, bool force) {
    const PendingOutput probe(arguments.file, force);
}

}  // namespace stipple
