#include "apps/output/json_file.h"

#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "apps/standard_streams.h"
#include "io/text_file.h"
#include "stream/plain_text.h"

namespace stipple {

JsonFile::JsonFile(const RunOptions& run) : to_stdout_(run.json == "-") {
    if (!run.json.empty() && !to_stdout_) output_.emplace(run.json, run.force);
}

void JsonFile::write(nlohmann::ordered_json figures) {
    using nlohmann::ordered_json;
    if (auto warnings = said_warnings(); !warnings.empty())
        figures["warnings"] = std::move(warnings);
    // Bytes of a damaged file that are no UTF-8 must not stop the report.
    const std::string text =
        terminal_text(figures.dump(2, ' ', false, ordered_json::error_handler_t::replace)) + "\n";
    if (to_stdout_) print_text(text);
    if (output_) write_text(*output_, text);
}

}  // namespace stipple
