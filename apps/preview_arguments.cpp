#include "apps/preview_arguments.h"

#include <filesystem>

#include "apps/size_argument.h"
#include "core/error.h"
#include "core/pending_output.h"

namespace stipple {
namespace {

std::string check_extension(const std::string& file) {
    const auto extension = std::filesystem::path(file).extension();
    if (extension == ".png" || extension == ".npy") return {};
    return "\"" + file + "\" is neither a .png nor a .npy file";
}

}  // namespace

void add_preview_arguments(Command& command, PreviewArguments& arguments) {
    constexpr int kLeast = 8;
    constexpr int kMost = 65536;
    command
        .add_option("--preview", arguments.file,
                    "picture of what the decoder makes of the newest slots, replaced again and "
                    "again: .png to look at, .npy linear light")
        .check(check_extension)
        .type_name("FILE")
        .output();
    command
        .add_option("--preview-method", arguments.method,
                    "naive: at once, noisier; fast: as it will be decoded, in seconds (naive)")
        .one_of({"fast", "naive"})
        .type_name("NAME");
    command
        .add_parsed(
            "--preview-size",
            [&arguments](const std::string& text) {
                parse_size("--preview-size", text, kLeast, kMost, arguments.size.emplace());
            },
            "so much of the middle of the frame (all, or what is decoded in some seconds)")
        .type_name("WxH");
}

void check_preview_file(const PreviewArguments& arguments, bool force) {
    const PendingOutput probe(arguments.file, force);
}

}  // namespace stipple
