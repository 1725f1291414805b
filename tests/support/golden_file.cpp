#include "tests/support/golden_file.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <nlohmann/json.hpp>

#include "tests/support/temporary_folder.h"

namespace stipple {

bool updating_golden() {
    return std::getenv("STIPPLE_UPDATE_GOLDEN") != nullptr;
}

void expect_golden_text(const std::filesystem::path& file, const std::string& text) {
    if (updating_golden()) write_text(file, text);
    EXPECT_EQ(read_text(file), text) << file;
}

void expect_golden_bytes(const std::filesystem::path& file, const std::string& bytes) {
    if (updating_golden()) write_text(file, bytes);
    EXPECT_TRUE(read_text(file) == bytes) << file;
}

std::string golden_text(const nlohmann::ordered_json& object) {
    std::string lines = "{";
    for (const auto& [key, value] : object.items()) {
        lines += (lines.size() > 1 ? ",\n" : "\n") + nlohmann::ordered_json(key).dump() + ": ";
        if (!value.is_array() || value.empty()) {
            lines += value.dump();
            continue;
        }
        for (std::size_t i = 0; i < value.size(); ++i)
            lines += (i == 0 ? "[\n  " : ",\n  ") + value[i].dump();
        lines += "]";
    }
    return lines + "\n}\n";
}

}  // namespace stipple
