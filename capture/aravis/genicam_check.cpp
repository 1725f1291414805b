#include "capture/aravis/genicam_check.h"

#include <arv.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <string_view>
#include <vector>

#include "core/error.h"

namespace stipple {
namespace {

/// Elements that name what the value of a feature is made of. Its limits, and whether it is
/// available, are values of their own: those of Width and OffsetX name each other.
constexpr std::array<std::string_view, 8> kParts{"pValue",     "pValueIndexed", "pValueDefault",
                                                 "pValueCopy", "pVariable",     "pAddress",
                                                 "pLength",    "pIndex"};

std::string text_of(ArvDomNode* element) {
    ArvDomNode* const child = arv_dom_node_get_first_child(element);
    if (child == nullptr || !ARV_IS_DOM_CHARACTER_DATA(child)) return {};
    const char* text = arv_dom_character_data_get_data(ARV_DOM_CHARACTER_DATA(child));
    return text == nullptr ? std::string() : std::string(text);
}

/// Empty if it is no feature.
std::string name_of(ArvDomNode* element) {
    if (!ARV_IS_GC_FEATURE_NODE(element)) return {};
    const char* name = arv_gc_feature_node_get_name(ARV_GC_FEATURE_NODE(element));
    return name == nullptr ? std::string() : std::string(name);
}

/// How many values are read for one.
class ValueCosts {
  public:
    explicit ValueCosts(ArvDomNode* description) {
        struct Open {
            ArvDomNode* node;
            std::string feature;  ///< that it belongs to
        };
        std::vector<Open> open{{description, {}}};
        while (!open.empty()) {
            const auto [parent, feature] = std::move(open.back());
            open.pop_back();
            for (ArvDomNode* node = arv_dom_node_get_first_child(parent); node != nullptr;
                 node = arv_dom_node_get_next_sibling(node)) {
                if (!ARV_IS_DOM_ELEMENT(node)) continue;
                const std::string_view tag = arv_dom_node_get_node_name(node);
                if (std::find(kParts.begin(), kParts.end(), tag) != kParts.end())
                    features_[feature].parts.push_back(text_of(node));
                else
                    open.push_back({node, feature.empty() ? name_of(node) : feature});
            }
        }
    }

    /// The first feature whose value takes more than `most`; empty if there is none.
    [[nodiscard]] std::string costly_feature(double max_cost) {
        for (const auto& [name, feature] : features_)
            if (cost(name, 0) > max_cost) return name;
        return {};
    }

  private:
    struct Feature {
        std::vector<std::string> parts;
        double cost = 0;  ///< 0: not yet known
    };

    double cost(const std::string& name, int depth) {
        constexpr int kMaxDeep = 64;
        const auto found = features_.find(name);
        if (found == features_.end()) return 1;
        if (depth == kMaxDeep) return std::numeric_limits<double>::infinity();
        Feature& feature = found->second;
        if (feature.cost > 0) return feature.cost;
        double sum = 1;
        for (const std::string& part : feature.parts) sum += cost(part, depth + 1);
        return feature.cost = sum;
    }

    std::map<std::string, Feature> features_;
};

}  // namespace

void check_genicam(void* device, const std::string& address) {
    constexpr double kMaxValues = 1000;
    ArvGc* const description = arv_device_get_genicam(static_cast<ArvDevice*>(device));
    if (description == nullptr) return;
    const std::string costly = ValueCosts(ARV_DOM_NODE(description)).costly_feature(kMaxValues);
    if (!costly.empty())
        throw DeviceError(address, fmt::format("describes itself in a circle: the value of its "
                                               "feature {} depends on itself, or on others in "
                                               "more than {} ways",
                                               costly, kMaxValues));
}

}  // namespace stipple
