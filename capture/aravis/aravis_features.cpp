#include <arv.h>
#include <fmt/format.h>

#include <limits>

#include "capture/aravis/aravis_call.h"
#include "capture/aravis/aravis_camera.h"
#include "capture/aravis/aravis_device.h"

namespace stipple {
namespace {

std::string text_of(const char* text) {
    return text == nullptr ? std::string() : std::string(text);
}

/// The value that `get` reads, as text; nothing if the camera does not tell, for which Aravis has
/// the lowest, the highest and the smallest number.
template <typename Node, typename Number>
std::optional<std::string> told(const std::string& address, Node* node,
                                Number (*get)(Node*, GError**)) {
    using Limits = std::numeric_limits<Number>;
    GlibError error;
    const Number value = get(node, error.slot());
    error.check_answer(address);
    if (error.any() || value == Limits::lowest() || value == Limits::max() ||
        value == Limits::min())
        return {};
    return fmt::format("{}", value);
}

/// Booleans and choices come first: they are integers too.
std::string type_of(ArvGcNode* node) {
    if (ARV_IS_GC_BOOLEAN(node)) return "boolean";
    if (ARV_IS_GC_ENUMERATION(node)) return "choice";
    if (ARV_IS_GC_COMMAND(node)) return "command";
    if (ARV_IS_GC_STRING(node)) return "text";
    if (ARV_IS_GC_FLOAT(node)) return "float";
    if (ARV_IS_GC_INTEGER(node)) return "integer";
    return ARV_IS_GC_REGISTER(node) ? "register" : "unknown";
}

/// `access` and `locked`.
void describe_access(const std::string& address, ArvGcFeatureNode* node, CameraFeature& feature) {
    feature.access = "na";
    GlibError error;
    const bool available = arv_gc_feature_node_is_available(node, error.slot()) != FALSE;
    error.check_answer(address);
    if (!available) return;
    const bool locked = arv_gc_feature_node_is_locked(node, error.slot()) != FALSE;
    error.check_answer(address);
    const ArvGcAccessMode mode = arv_gc_feature_node_get_actual_access_mode(node);
    feature.locked = locked && mode != ARV_GC_ACCESS_MODE_RO;
    if (mode == ARV_GC_ACCESS_MODE_RO)
        feature.access = "ro";
    else if (mode == ARV_GC_ACCESS_MODE_WO)
        feature.access = locked ? "na" : "wo";
    else
        feature.access = locked ? "ro" : "rw";
}

void describe_number(const std::string& address, ArvGcNode* node, CameraFeature& feature) {
    if (feature.type == "integer") {
        auto* const number = ARV_GC_INTEGER(node);
        feature.minimum = told(address, number, arv_gc_integer_get_min);
        feature.maximum = told(address, number, arv_gc_integer_get_max);
        feature.increment = told(address, number, arv_gc_integer_get_inc);
        feature.unit = text_of(arv_gc_integer_get_unit(number));
    } else if (feature.type == "float") {
        auto* const number = ARV_GC_FLOAT(node);
        feature.minimum = told(address, number, arv_gc_float_get_min);
        feature.maximum = told(address, number, arv_gc_float_get_max);
        feature.increment = told(address, number, arv_gc_float_get_inc);
        feature.unit = text_of(arv_gc_float_get_unit(number));
    }
}

std::vector<std::string> choices_of(const std::string& address, ArvGcNode* node) {
    guint count = 0;
    GlibError error;
    const char** const names = arv_gc_enumeration_dup_available_string_values(
        ARV_GC_ENUMERATION(node), &count, error.slot());
    std::vector<std::string> choices;
    for (guint i = 0; names != nullptr && i < count; ++i) choices.push_back(text_of(names[i]));
    g_free(names);
    error.check_answer(address);
    return choices;
}

CameraFeature described(const AravisDevice& device, ArvGcNode* node, const FeatureName& name) {
    auto* const feature_node = ARV_GC_FEATURE_NODE(node);
    CameraFeature feature{.name = name.name, .category = name.category, .type = type_of(node)};
    describe_access(device.address(), feature_node, feature);
    feature.text = text_of(arv_gc_feature_node_get_tooltip(feature_node));
    if (feature.text.empty())
        feature.text = text_of(arv_gc_feature_node_get_description(feature_node));
    if (feature.access == "na") return feature;
    feature.value = device.read(name.name);
    describe_number(device.address(), node, feature);
    if (feature.type == "choice") feature.choices = choices_of(device.address(), node);
    return feature;
}

}  // namespace

std::vector<CameraFeature> describe_features(const AravisDevice& device) {
    ArvDevice* const opened = arv_camera_get_device(static_cast<ArvCamera*>(device.native()));
    std::vector<CameraFeature> features;
    for (const FeatureName& name : device.feature_names()) {
        ArvGcNode* const node = arv_device_get_feature(opened, name.name.c_str());
        if (node != nullptr && ARV_IS_GC_FEATURE_NODE(node) && !ARV_IS_GC_CATEGORY(node))
            features.push_back(described(device, node, name));
    }
    return features;
}

std::vector<CameraFeature> aravis_features(const std::string& address) {
    return within_limited_time(address,
                               [address] { return describe_features(AravisDevice(address)); });
}

}  // namespace stipple
