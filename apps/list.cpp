#include <fmt/format.h>

#include <cctype>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "apps/key_list.h"
#include "apps/output/json_file.h"
#include "apps/output/text_layout.h"
#include "apps/subcommands.h"
#include "core/config.h"
#include "core/input_file.h"
#include "core/text.h"
#include "decoder/reconstruct.h"
#include "study/scenes/scene.h"

namespace stipple {
namespace {

/// A name that an option takes, with its description.
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

/// The beginning of the comment up to its first full stop or colon, without a page of docs/.
std::string title_of(const std::string& comment) {
    std::size_t end = 0;
    for (; end + 2 < comment.size(); ++end) {
        const bool sentence = comment[end] == '.' && std::isupper(comment[end + 2]) != 0;
        if (comment[end + 1] == ' ' && (sentence || comment[end] == ':')) break;
    }
    std::string title = end + 2 < comment.size() ? comment.substr(0, end) : comment;
    if (title.ends_with('.')) title.pop_back();
    if (const auto page = title.rfind(" (docs/"); page != std::string::npos) title.resize(page);
    return title;
}

std::vector<Entry> configurations(ConfigKind kind) {
    require_configs(kind);
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
        entries = configurations(kind == "sensors"  ? ConfigKind::kSensors
                                 : kind == "rigs"   ? ConfigKind::kRigs
                                 : kind == "spaces" ? ConfigKind::kSpaces
                                                    : ConfigKind::kSchedules);
    return entries;
}

void list_names(const std::string& kind, const RunOptions& run) {
    JsonFile json(run);
    const auto entries = entries_of(kind);
    const std::size_t width = column_width(entries, &Entry::name);
    auto names = nlohmann::ordered_json::array();
    std::string text;
    for (const auto& [name, what] : entries) {
        names.push_back({{"name", name}, {"text", what}});
        text += fmt::format("{}{:<{}}  {}", text.empty() ? "" : "\n", name, width, what);
    }
    json.write({{kind, names}});
    run.say(text);
}

/// Unit and range of a key, in brackets.
std::string taken(const KnownKey& key) {
    std::vector<std::string> words{key.unit, key.range};
    std::erase(words, "");
    return words.empty() ? "" : fmt::format(" ({})", joined(words));
}

struct ListOptions {
    std::string kind;
    std::string section;
    std::string of;
    std::vector<KeyList> keys = {};
};

void list_keys(const ListOptions& options, const RunOptions& run) {
    JsonFile json(run);
    auto keys = nlohmann::ordered_json::array();
    std::string text;
    for (const KeyList& list : options.keys) {
        const std::size_t name_width = column_width(list.keys, &KnownKey::name);
        const std::size_t value_width = column_width(list.keys, &KnownKey::fallback);
        text += fmt::format("{}{} {}{}", text.empty() ? "" : "\n\n", list.section, list.of,
                            list.keys.empty() ? ": no keys" : "");
        for (const KnownKey& key : list.keys) {
            const std::string name = fmt::format("{}.{}", list.section, key.name);
            text +=
                fmt::format("\n  {:<{}}  {:<{}}  {}{}", name, list.section.size() + 1 + name_width,
                            key.fallback, value_width, key.text, taken(key));
            keys.push_back({{"name", name},
                            {"of", list.of},
                            {"default", key.fallback},
                            {"range", key.range},
                            {"unit", key.unit},
                            {"text", key.text}});
        }
    }
    json.write({{"keys", keys}});
    run.say(text);
}

void list(const ListOptions& options, const RunOptions& run) {
    if (options.kind == "keys")
        list_keys(options, run);
    else
        list_names(options.kind, run);
}

}  // namespace

void add_list(Command& app, Action& action) {
    Command command = app.add_command(
        "list", "Names of sensors, schedules, rigs, spaces, scenes or methods, keys of --set");
    const auto options = std::make_shared<ListOptions>();
    command.add_option("KIND", options->kind, "list of names, or of the keys of --set")
        .one_of({"sensors", "schedules", "rigs", "spaces", "scenes", "methods", "keys"})
        .required();
    command.add_option("SECTION", options->section, "section of the keys")
        .default_text("all")
        .one_of({"sensor", "schedule", "decoder"});
    command
        .add_option("OF", options->of,
                    "of these keys: a sensor, its mode or timing, kind of schedule, or method")
        .default_text("all");
    command.footer(
        "Examples:\n"
        "  stipple list sensors\n"
        "  stipple list schedules --json -\n"
        "  stipple list keys sensor\n"
        "  stipple list keys decoder fast\n"
        "A key has a line: default, meaning, unit and range. Those of the section camera are the\n"
        "features of the camera.");
    set_action(command, action, options, list, [command, options] {
        if (options->kind == "keys")
            options->keys = key_lists(options->section, options->of);
        else
            command.refuse({"SECTION"}, fmt::format("\"{}\" is more than stipple list {} takes",
                                                    options->section, options->kind));
    });
}

}  // namespace stipple
