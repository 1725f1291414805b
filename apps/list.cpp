#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "apps/report/json_file.h"
#include "apps/subcommands.h"
#include "core/config.h"
#include "core/input_file.h"
#include "decoder/reconstruct.h"
#include "scenes/scene.h"

namespace stipple {
namespace {

/// A name that an option takes, and what it stands for.
struct Entry {
    std::string name;
    std::string text;
};

/// The comment that a configuration file begins with, as one line.
std::string first_comment(const std::filesystem::path& file) {
    const auto bytes = read_file(file);
    std::istringstream lines(std::string(bytes.begin(), bytes.end()));
    std::string text;
    for (std::string line; std::getline(lines, line) && line.starts_with('#');) {
        const auto begin = line.find_first_not_of("# \t");
        if (begin != std::string::npos) text.append(text.empty() ? "" : " ").append(line, begin);
    }
    return text;
}

/// What it says up to its first full stop or colon, without a page of docs/ at the end.
std::string title_of(const std::string& comment) {
    std::size_t end = 0;
    for (; end + 2 < comment.size(); ++end) {
        const bool sentence = comment[end] == '.' && std::isupper(comment[end + 2]) != 0;
        if (comment[end + 1] == ' ' && (sentence || comment[end] == ':')) break;
    }
    std::string title = comment.substr(0, end);
    if (const auto page = title.rfind(" (docs/"); page != std::string::npos) title.resize(page);
    return title;
}

std::vector<Entry> configurations(const std::string& kind) {
    std::vector<Entry> entries;
    for (const std::string& name : config_names(kind))
        entries.push_back({name, title_of(first_comment(find_config(kind, name)))});
    return entries;
}

std::vector<Entry> entries_of(const std::string& kind) {
    std::vector<Entry> entries;
    if (kind == "scenes")
        for (const NamedScene& scene : scenes())
            entries.push_back({std::string(scene.name), std::string(scene.text)});
    else if (kind == "methods")
        for (const NamedDecodeMethod& method : decode_methods())
            entries.push_back({std::string(method.name), std::string(method.text)});
    else
        entries = configurations(kind);
    return entries;
}

void list(const std::string& kind, const RunOptions& run) {
    JsonFile json(run);
    const auto entries = entries_of(kind);
    std::size_t width = 0;
    for (const Entry& entry : entries) width = std::max(width, entry.name.size());
    auto names = nlohmann::ordered_json::array();
    std::string text;
    for (const auto& [name, what] : entries) {
        names.push_back({{"name", name}, {"text", what}});
        text += fmt::format("{}{:<{}}  {}", text.empty() ? "" : "\n", name, width, what);
    }
    json.write({{kind, names}});
    run.say(text);
}

}  // namespace

void add_list(Command& app, Action& action) {
    Command command = app.add_command("list", "Names of sensors, schedules, scenes or methods");
    const auto kind = std::make_shared<std::string>();
    command.add_option("KIND", *kind, "sensors, schedules, scenes or methods")
        .one_of({"sensors", "schedules", "scenes", "methods"})
        .required();
    command.footer(
        "Examples:\n"
        "  stipple list sensors\n"
        "  stipple list schedules --json -");
    set_action(command, action, kind, list);
}

}  // namespace stipple
