#include "io/npy_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "core/error.h"

namespace stipple {
namespace {

/// Walks through the text of a Python literal.
class Cursor {
  public:
    Cursor(std::string_view text, std::string_view where) : rest_(text), where_(where) {}

    [[noreturn]] void fail(std::string_view problem) const {
        throw InputError(where_, fmt::format("malformed .npy header: {}", problem));
    }
    bool accept(char c) {
        skip_space();
        if (!rest_.starts_with(c)) return false;
        rest_.remove_prefix(1);
        return true;
    }
    void expect(char c) {
        if (!accept(c)) fail(fmt::format("'{}' is missing", c));
    }
    std::string_view quoted() {
        const char quote = accept('"') ? '"' : '\'';
        if (quote == '\'' && !accept('\'')) fail("text in quotes is missing");
        const auto end = rest_.find(quote);
        if (end == std::string_view::npos) fail("a closing quote is missing");
        return take(end, 1);
    }
    bool boolean() {
        skip_space();
        for (const std::string_view word : {"True", "False"})
            if (rest_.starts_with(word)) return take(word.size(), 0) == "True";
        fail("True or False is missing");
    }
    std::uint64_t integer() {
        skip_space();
        std::uint64_t value = 0;
        const auto [end, error] = std::from_chars(rest_.data(), rest_.data() + rest_.size(), value);
        if (error != std::errc()) fail("a size is not a number, or too large");
        take(static_cast<std::size_t>(end - rest_.data()), 0);
        return value;
    }
    /// Whether nothing follows but a comment.
    [[nodiscard]] bool at_end() {
        skip_space();
        if (rest_.starts_with('#')) take(std::min(rest_.find('\n'), rest_.size()), 0);
        skip_space();
        return rest_.empty();
    }

  private:
    void skip_space() {
        const auto first = rest_.find_first_not_of(" \n");
        rest_.remove_prefix(std::min(first, rest_.size()));
    }
    std::string_view take(std::size_t length, std::size_t closing) {
        const auto result = rest_.substr(0, length);
        rest_.remove_prefix(length + closing);
        return result;
    }

    std::string_view rest_;
    std::string_view where_;
};

std::vector<std::uint64_t> read_tuple(Cursor& cursor) {
    std::vector<std::uint64_t> values;
    cursor.expect('(');
    while (!cursor.accept(')')) {
        values.push_back(cursor.integer());
        if (!cursor.accept(',')) {
            cursor.expect(')');
            break;
        }
    }
    return values;
}

}  // namespace

NpyFields read_npy_fields(std::string_view dictionary, std::string_view where) {
    Cursor cursor(dictionary, where);
    NpyFields fields;
    bool has_descr = false;
    bool has_order = false;
    bool has_shape = false;
    cursor.expect('{');
    while (!cursor.accept('}')) {
        const auto key = cursor.quoted();
        cursor.expect(':');
        if (key == "descr") {
            fields.descr = cursor.quoted();
            has_descr = true;
        } else if (key == "fortran_order") {
            fields.fortran_order = cursor.boolean();
            has_order = true;
        } else if (key == "shape") {
            fields.shape = read_tuple(cursor);
            has_shape = true;
        } else {
            cursor.fail(fmt::format("entry \"{}\" is unknown", key));
        }
        if (!cursor.accept(',')) {
            cursor.expect('}');
            break;
        }
    }
    if (!cursor.at_end()) cursor.fail("text follows the dictionary");
    if (!has_descr || !has_order || !has_shape)
        cursor.fail("descr, fortran_order or shape is missing");
    return fields;
}

}  // namespace stipple
