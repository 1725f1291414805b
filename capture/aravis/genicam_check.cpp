#include "capture/aravis/genicam_description.h"

#include <arv.h>
#include <fmt/format.h>
#include <tinyxml2.h>

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

/// All registers of numbers and texts together; those of real cameras have some 10 kB.
constexpr std::uint64_t kMaxRegisterBytes = std::uint64_t{4} << 20U;

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
                if (std::find(kParts.begin(), kParts.end(), tag) != kParts.end()) {
                    features_[feature].parts.push_back(text_of(node));
                    continue;
                }
                std::string name = name_of(node);
                if (name.empty() && ARV_IS_GC_REGISTER(node))  // a StructReg has none
                    name = fmt::format("{} {}", tag, registers_.size());
                // Those without a type are not read: file buffers, tables.
                if (ARV_IS_GC_REGISTER(node) && tag != "Register")
                    registers_.push_back({node, name});
                if (tag == "StructEntry") features_[name].parts.push_back(feature);
                open.push_back({node, feature.empty() ? name : feature});
            }
        }
    }

    /// The first feature whose value takes more than `max_cost`; empty if there is none.
    [[nodiscard]] std::string costly_feature(double max_cost) {
        for (const auto& [name, feature] : features_)
            if (cost(name, 0) > max_cost) return name;
        return {};
    }

    /// All registers, each behind those that its length depends on.
    /// Precondition: no feature is costly.
    [[nodiscard]] std::vector<GenicamRegister> take_registers() {
        std::stable_sort(
            registers_.begin(), registers_.end(),
            [this](const auto& a, const auto& b) { return cost(a.name, 0) < cost(b.name, 0); });
        return std::move(registers_);
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
        // While it is met on the way to itself.
        feature.cost = std::numeric_limits<double>::infinity();
        double sum = 1;
        for (const std::string& part : feature.parts) sum += cost(part, depth + 1);
        return feature.cost = sum;
    }

    std::map<std::string, Feature> features_;
    std::vector<GenicamRegister> registers_;
};

/// Whether the length is a number, not the value of a feature.
bool has_own_length(const GenicamRegister& one) {
    for (ArvDomNode* part = arv_dom_node_get_first_child(ARV_DOM_NODE(one.node)); part != nullptr;
         part = arv_dom_node_get_next_sibling(part))
        if (ARV_IS_DOM_ELEMENT(part) &&
            std::string_view(arv_dom_node_get_node_name(part)) == "pLength")
            return false;
    return true;
}

}  // namespace

GenicamCheck::GenicamCheck(void* device, std::string address) : address_(std::move(address)) {
    constexpr double kMaxValues = 1000;
    ArvGc* const description = arv_device_get_genicam(static_cast<ArvDevice*>(device));
    if (description == nullptr) return;
    // Of what is not well-formed, Aravis finds by name features that its tree does not hold.
    std::size_t bytes = 0;
    const char* const xml = arv_device_get_genicam_xml(static_cast<ArvDevice*>(device), &bytes);
    if (tinyxml2::XMLDocument parsed; parsed.Parse(xml, bytes) != tinyxml2::XML_SUCCESS)
        throw DeviceError(address_, fmt::format("describes itself in XML that is not well-formed "
                                                "in line {}",
                                                parsed.ErrorLineNum()));
    ValueCosts costs(ARV_DOM_NODE(description));
    if (const std::string costly = costs.costly_feature(kMaxValues); !costly.empty())
        throw DeviceError(address_, fmt::format("describes itself in a circle: the value of its "
                                                "feature {} depends on itself, or on others in "
                                                "more than {} ways",
                                                costly, kMaxValues));
    std::vector<GenicamRegister> registers = costs.take_registers();
    check(registers);
    std::erase_if(registers, has_own_length);
    variable_ = std::move(registers);
}

void GenicamCheck::check_lengths() const {
    check(variable_);
}

void GenicamCheck::check(const std::vector<GenicamRegister>& registers) const {
    std::uint64_t sum = 0;
    for (const auto& [node, name] : registers) {
        GError* error = nullptr;
        const std::uint64_t bytes =
            arv_gc_register_get_length(static_cast<ArvGcRegister*>(node), &error);
        const bool failed = error != nullptr;
        g_clear_error(&error);
        if (failed) continue;
        sum += std::min(bytes, kMaxRegisterBytes + 1);
        if (sum > kMaxRegisterBytes)
            throw DeviceError(address_, fmt::format("describes registers that are too long: with "
                                                    "{} of {} bytes they exceed {} bytes together",
                                                    name, bytes, kMaxRegisterBytes));
    }
}

}  // namespace stipple
