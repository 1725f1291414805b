#include "study/metrics/emva1288/series_evaluation.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/error.h"
#include "study/metrics/emva1288/high_pass.h"

namespace stipple::emva1288 {
namespace {

GroupStatistics statistics_of(const ImageGroup& group, const Series& series,
                              const std::filesystem::path& folder, const ReadImage& read) {
    ImageStack stack;
    std::int64_t zeros = 0, values = 0;
    for (const std::string& file : group.files) {
        const SeriesImage image = read(folder / file);
        require_image_of(series, image, (folder / file).string());
        stack.add(image.dn);
        zeros += std::ranges::count(image.dn, 0);
        values += std::ssize(image.dn);
    }
    const bool has_split = group.files.size() > 2 && series.rows > 2 && series.cols > 2;
    GroupStatistics found{
        .count = group.files.size(),
        .images = stack.statistics(),
        .split = has_split ? stack.spatial_variances(series.cols) : SpatialVariances{},
        .zero_fraction = static_cast<double>(zeros) / static_cast<double>(values)};
    if (group.files.size() > 2) {
        found.mean_image = {series.rows, series.cols, stack.mean_image()};
        found.high_pass_dn2 =
            high_pass_variance(found.mean_image) -
            found.images.temporal_variance_dn2 / static_cast<double>(group.files.size());
    }
    return found;
}

}  // namespace

void require_image_of(const Series& series, const SeriesImage& image, const std::string& where) {
    if (image.rows != series.rows || image.cols != series.cols)
        throw InputError(where, fmt::format("is {} x {}, but the descriptor says {} x {}",
                                            image.cols, image.rows, series.cols, series.rows));
    const int max_dn = *std::ranges::max_element(image.dn);
    if (max_dn >> series.bits != 0)
        throw InputError(where, fmt::format("holds the DN {}, but the descriptor says {} bits",
                                            max_dn, series.bits));
}

Evaluation evaluate(const Series& series, const std::filesystem::path& folder,
                    const ReadImage& read, const std::string& where) {
    std::vector<GroupStatistics> statistics;
    for (const ImageGroup& group : series.groups)
        statistics.push_back(statistics_of(group, series, folder, read));
    return evaluate(series, statistics, where);
}

}  // namespace stipple::emva1288
