#include "io/text_file.h"

#include <span>
#include <system_error>

#include "core/error.h"
#include "io/output_file.h"

namespace stipple {

void write_whole(const std::filesystem::path& path, const std::string& name,
                 std::string_view text) {
    try {
        OutputFile output(path, name);
        output.write(std::as_bytes(std::span(text)));
        output.close();
    } catch (const DeviceError&) {
        std::error_code error;
        std::filesystem::remove(path, error);
        throw;
    }
}

void write_text(PendingOutput& output, std::string_view text) {
    write_whole(output.partial(), output.final_path().string(), text);
    output.commit();
}

void write_text_file(const std::filesystem::path& file, bool force, std::string_view text) {
    PendingOutput output(file, force);
    write_text(output, text);
}

}  // namespace stipple
