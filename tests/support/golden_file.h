#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace stipple {

/// A file of tests/golden as the code makes it, without its extension.
struct GoldenCase {
    std::string name;
    std::string bytes;
};

/// True if this run writes the golden files instead of reading them: STIPPLE_UPDATE_GOLDEN is set.
[[nodiscard]] bool updating_golden();

/// Expects that a golden file of text holds `text`.
void expect_golden_text(const std::filesystem::path& file, const std::string& text);

/// The same of bytes, which a failure does not show.
void expect_golden_bytes(const std::filesystem::path& file, const std::string& bytes);

/// A JSON object as the golden files hold it: a line per field, and per element of a list.
[[nodiscard]] std::string golden_text(const nlohmann::ordered_json& object);

}  // namespace stipple
