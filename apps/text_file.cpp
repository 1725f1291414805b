#include "apps/text_file.h"

#include <span>

#include "core/output_file.h"
#include "core/pending_output.h"

namespace stipple {

void write_text_file(const std::filesystem::path& file, bool force, std::string_view text) {
    PendingOutput pending(file, force);
    OutputFile output(pending.partial(), file.string());
    output.write(std::as_bytes(std::span(text)));
    output.close();
    pending.commit();
}

}  // namespace stipple
