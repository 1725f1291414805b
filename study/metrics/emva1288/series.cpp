#include "study/metrics/emva1288/series.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "core/error.h"
#include "core/geometry.h"
#include "core/text.h"

namespace stipple::emva1288 {
namespace {

constexpr std::size_t kMaxGroups = 100000;
constexpr std::size_t kMaxImages = 1000000;

class Parser {
  public:
    explicit Parser(std::string_view where) : where_(where) {}

    void read_line(const std::string& line) {
        ++line_;
        std::istringstream words(line);
        std::string key;
        if (!(words >> key) || key.front() == '#') return;
        if (key == "l") return;  // a label of the series, for people
        if (key == "v")
            read_version(words);
        else if (key == "n")
            read_format(words);
        else if (key == "b" || key == "d")
            begin_group(words, key == "d");
        else if (key == "i")
            read_image(words);
        else if (key == "dc")
            fail("dark-current images (dc) are not evaluated; take their lines out");
        else
            fail(fmt::format("\"{}\" is none of v, n, b, d, i", key));
        std::string rest;
        if (words >> rest) fail(fmt::format("\"{}\" is more than the line needs", rest));
    }

    [[nodiscard]] Series finished() {
        if (series_.bits == 0)
            fail("the file has no line \"n bits width height\", which all images need");
        end_group();
        if (series_.groups.empty()) fail("the file names no images");
        return std::move(series_);
    }

  private:
    [[noreturn]] void fail(std::string_view problem) const {
        throw InputError(fmt::format("{}:{}", where_, line_), problem);
    }

    double number(std::istringstream& words, std::string_view what, double min, double max) {
        std::string word;
        if (!(words >> word)) fail(fmt::format("{} is missing", what));
        std::ranges::replace(word, ',', '.');  // as the reference software
        const auto value = parsed_number<double>(word);
        if (!value) fail(fmt::format("{} \"{}\" is not a number", what, word));
        if (!(*value >= min && *value <= max))
            fail(fmt::format("{} {} is outside {}..{}", what, word, min, max));
        return *value;
    }

    int integer(std::istringstream& words, std::string_view what, double max) {
        const double value = number(words, what, 1, max);
        if (value != std::floor(value)) fail(fmt::format("{} is not a whole number", what));
        return static_cast<int>(value);
    }

    void read_version(std::istringstream& words) {
        std::string version;
        words >> version;
        const double number = parsed_number<double>(version).value_or(0);
        if (!(number >= 3 && number < 5))
            fail(fmt::format("version \"{}\" of the descriptor; this program reads 3.x and 4.x",
                             version));
    }

    void read_format(std::istringstream& words) {
        if (series_.bits != 0) fail("a second line n");
        series_.bits = integer(words, "bits", 16);
        series_.cols = integer(words, "width", kMaxFrameSide);
        series_.rows = integer(words, "height", kMaxFrameSide);
    }

    void begin_group(std::istringstream& words, bool dark) {
        end_group();
        if (series_.groups.size() == kMaxGroups) fail("too many groups of images");
        ImageGroup group{.dark = dark, .files = {}};
        group.exposure_ns = number(words, "exposure in ns", 0, 1e18);
        if (!dark) group.photons = number(words, "photons", 0, 1e12);
        series_.groups.push_back(std::move(group));
    }

    void end_group() const {
        if (!series_.groups.empty() && series_.groups.back().files.size() < 2)
            fail("the group of images before has fewer than the two that tell noise");
    }

    void read_image(std::istringstream& words) {
        if (series_.groups.empty()) fail("an image before the first line b or d");
        if (++images_ > kMaxImages) fail("too many images");
        std::string file;
        std::getline(words >> std::ws, file);
        while (!file.empty() && (file.back() == '\r' || file.back() == ' ')) file.pop_back();
        if (file.empty()) fail("the name of the image is missing");
        std::ranges::replace(file, '\\', '/');
        series_.groups.back().files.push_back(file);
    }

    std::string where_;
    int line_ = 0;
    std::size_t images_ = 0;
    Series series_;
};

}  // namespace

Series parse_series(std::string_view text, std::string_view where) {
    Parser parser(where);
    while (!text.empty()) {
        const std::size_t end = std::min(text.find('\n'), text.size());
        parser.read_line(std::string(text.substr(0, end)));
        text.remove_prefix(std::min(end + 1, text.size()));
    }
    return parser.finished();
}

std::string series_text(const Series& series) {
    std::string text = fmt::format("v 4.0\nn {} {} {}\n", series.bits, series.cols, series.rows);
    for (const ImageGroup& group : series.groups) {
        text += group.dark ? fmt::format("d {}\n", group.exposure_ns)
                           : fmt::format("b {} {}\n", group.exposure_ns, group.photons);
        for (const std::string& file : group.files) text += fmt::format("i {}\n", file);
    }
    return text;
}

}  // namespace stipple::emva1288
