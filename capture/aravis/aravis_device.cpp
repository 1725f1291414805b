#include "capture/aravis/aravis_device.h"

#include <arv.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <set>
#include <span>

#include "capture/aravis/aravis_call.h"
#include "capture/aravis/genicam_description.h"
#include "capture/doctor/doctor_findings.h"
#include "capture/network.h"
#include "core/error.h"
#include "core/text.h"

namespace stipple {
namespace {

ArvDevice* open_gige(const std::string& address, const std::string& ip) {
    const auto number = parse_ipv4(ip);
    if (!number)
        throw InputError(address,
                         "is not an IPv4 address: write gige:192.168.0.5 (\"stipple capture "
                         "list\" shows the cameras that answer)");
    check_genicam_download(address, *number);
    GlibError error;
    ArvDevice* device =
        arv_interface_open_device(arv_gv_interface_get_instance(), ip.c_str(), error.slot());
    if (device == nullptr)
        throw DeviceError(address, fmt::format("answers, but cannot be opened: {}", error.text()));
    return device;
}

ArvDevice* open_usb(const std::string& address, const std::string& serial) {
    ArvInterface* usb = arv_uv_interface_get_instance();
    arv_interface_update_device_list(usb);
    GlibError error;
    for (unsigned i = 0; i < arv_interface_get_n_devices(usb); ++i) {
        const char* found = arv_interface_get_device_serial_nbr(usb, i);
        if (found == nullptr || serial != found) continue;
        // Aravis would say so in two lines of its own on standard error.
        if (usb_camera_is_taken(serial))
            throw DeviceError(address, "another program has the camera: stop it");
        ArvDevice* device =
            arv_interface_open_device(usb, arv_interface_get_device_id(usb, i), error.slot());
        if (device != nullptr) return device;
        throw DeviceError(address,
                          fmt::format("cannot be opened ({}): another program may have it, "
                                      "or this user may not{}",
                                      error.text(), kAskDoctor));
    }
    throw DeviceError(address,
                      "no USB3 Vision camera has this serial number: check the cable, and "
                      "that this user may read and write its /dev/bus/usb node");
}

ArvDevice* open_device(const std::string& address) {
    const std::string rest = address.substr(address.find(':') + 1);
    return address.starts_with("gige:") ? open_gige(address, rest) : open_usb(address, rest);
}

/// The names of the entries of an enumeration; entries without a name cannot be chosen.
std::string choices_of(ArvDevice* device, const char* feature) {
    guint count = 0;
    const std::unique_ptr<const char*, decltype(&g_free)> names(
        arv_device_dup_available_enumeration_feature_values_as_strings(device, feature, &count,
                                                                       nullptr),
        g_free);
    std::string text;
    for (const char* name : std::span(names.get(), count))
        if (name != nullptr) text += fmt::format("{}{}", text.empty() ? "" : ", ", name);
    return text;
}

/// For the features that Aravis sets by the names that cameras of all ages have for them.
struct NumberFeature {
    std::string_view name;
    gboolean (*is_available)(ArvCamera*, GError**);
    void (*bounds)(ArvCamera*, double*, double*, GError**);
    void (*set)(ArvCamera*, double, GError**);
};
constexpr std::array<NumberFeature, 4> kNumbers{{
    {"AcquisitionFrameRate", arv_camera_is_frame_rate_available, arv_camera_get_frame_rate_bounds,
     arv_camera_set_frame_rate},
    {"ExposureTime", arv_camera_is_exposure_time_available, arv_camera_get_exposure_time_bounds,
     arv_camera_set_exposure_time},
    {"Gain", arv_camera_is_gain_available, arv_camera_get_gain_bounds, arv_camera_set_gain},
    {"BlackLevel", arv_camera_is_black_level_available, arv_camera_get_black_level_bounds,
     arv_camera_set_black_level},
}};

/// The values that an integer feature takes.
std::string range_of(ArvDevice* device, const char* feature) {
    GlibError error;
    gint64 min = 0, max = 0;
    arv_device_get_integer_feature_bounds(device, feature, &min, &max, error.slot());
    if (error.any()) return {};
    const gint64 step = arv_device_get_integer_feature_increment(device, feature, nullptr);
    return fmt::format("; it takes {} to {}{}", min, max,
                       step > 1 ? fmt::format(" in steps of {}", step) : "");
}

/// Of a camera; large ones have some thousand.
constexpr std::size_t kMaxFeatures = 20'000;

constexpr std::uint64_t kPrimaryApplicationPort = 0x0A10;  // GigE Vision 2.0, 27.38
constexpr std::uint64_t kPrimaryApplicationIp = 0x0A14;

}  // namespace

struct AravisDevice::Impl {
    ArvCamera* camera = nullptr;
    ArvDevice* device = nullptr;
    std::optional<GenicamCheck> check;

    ~Impl() { g_clear_object(&camera); }
    void set_number(const std::string& where, const NumberFeature& feature,
                    const std::string& value) const;
    void set_choice(const std::string& where, const char* feature, const std::string& value) const;
    void set_integer(const std::string& where, const char* feature, const std::string& value) const;
    void set_other(const std::string& where, const char* feature, const std::string& value) const;
};

AravisDevice::AravisDevice(const std::string& address)
    : AravisDevice(address, open_device(address)) {}

AravisDevice::AravisDevice(std::string address, void* device)
    : address_(std::move(address)), impl_(std::make_unique<Impl>()) {
    const std::unique_ptr<void, void (*)(void*)> opened(device, g_object_unref);
    impl_->check.emplace(device, address_);
    GlibError error;
    impl_->camera = arv_camera_new_with_device(static_cast<ArvDevice*>(device), error.slot());
    if (impl_->camera == nullptr)
        throw DeviceError(address_, fmt::format("is not a usable camera: {}", error.text()));
    impl_->device = arv_camera_get_device(impl_->camera);
    arv_device_set_range_check_policy(impl_->device, ARV_RANGE_CHECK_POLICY_ENABLE);
}

AravisDevice::~AravisDevice() = default;

void* AravisDevice::native() const {
    return impl_->camera;
}

bool AravisDevice::is_gige() const {
    return arv_camera_is_gv_device(impl_->camera) != FALSE;
}

bool AravisDevice::is_controller() const {
    return !is_gige() || arv_gv_device_is_controller(ARV_GV_DEVICE(impl_->device)) != FALSE;
}

std::string AravisDevice::controller() const {
    std::uint32_t ip = 0;
    std::uint32_t port = 0;
    if (!is_gige() ||
        arv_device_read_register(impl_->device, kPrimaryApplicationIp, &ip, nullptr) == FALSE ||
        ip == 0)
        return {};
    arv_device_read_register(impl_->device, kPrimaryApplicationPort, &port, nullptr);
    return fmt::format("{}:{}", ipv4_text(ip), port & 0xFFFFU);
}

bool AravisDevice::has(const std::string& feature) const {
    impl_->check->check_lengths();
    ArvGcNode* node = arv_device_get_feature(impl_->device, feature.c_str());
    if (node == nullptr || ARV_IS_GC_FEATURE_NODE(node) == FALSE) return false;
    GlibError error;
    const bool available =
        arv_gc_feature_node_is_available(ARV_GC_FEATURE_NODE(node), error.slot()) != FALSE;
    error.check_answer(address_);
    return available;
}

std::optional<std::string> AravisDevice::read(const std::string& feature) const {
    if (!has(feature)) return std::nullopt;
    ArvGcNode* node = arv_device_get_feature(impl_->device, feature.c_str());
    if (ARV_IS_GC_CATEGORY(node) || ARV_IS_GC_COMMAND(node)) return std::nullopt;
    auto* named = ARV_GC_FEATURE_NODE(node);
    if (arv_gc_feature_node_get_actual_access_mode(named) == ARV_GC_ACCESS_MODE_WO)
        return std::nullopt;
    GlibError error;
    const char* value = arv_gc_feature_node_get_value_as_string(named, error.slot());
    error.check_answer(address_);
    if (error.any() || value == nullptr) return std::nullopt;
    return std::string(value);
}

std::optional<double> AravisDevice::read_number(const std::string& feature) const {
    const auto text = read(feature);
    return text ? parsed_number<double>(*text) : std::nullopt;
}

void AravisDevice::Impl::set_number(const std::string& where, const NumberFeature& feature,
                                    const std::string& value) const {
    const auto number = parsed_number<double>(value);
    if (!number) throw InputError(where, fmt::format("needs a number, but is \"{}\"", value));
    // Aravis sets some to the nearest value that can be.
    double min = 0, max = 0;
    GlibError no_bounds;
    feature.bounds(camera, &min, &max, no_bounds.slot());
    const double rounding = 1e-6 * std::abs(max);
    if (!no_bounds.any() && !(*number >= min - rounding && *number <= max + rounding))
        throw InputError(where,
                         fmt::format("{} cannot be set; it takes {} to {}", value, min, max));
    GlibError error;
    feature.set(camera, *number, error.slot());
    error.check_answer(where);
    if (error.any())
        throw InputError(where, fmt::format("{} cannot be set ({})", value, error.text()));
}

void AravisDevice::Impl::set_choice(const std::string& where, const char* feature,
                                    const std::string& value) const {
    GlibError error;
    arv_device_set_string_feature_value(device, feature, value.c_str(), error.slot());
    error.check_answer(where);
    if (error.any())
        throw InputError(where, fmt::format("\"{}\" cannot be set ({}); the camera has {}", value,
                                            error.text(), choices_of(device, feature)));
    check->check_lengths();
    const char* back = arv_device_get_string_feature_value(device, feature, nullptr);
    if (back == nullptr || value != back)
        throw DeviceError(where, fmt::format("asked for {}, the camera stays at {}", value,
                                             back == nullptr ? "?" : back));
}

void AravisDevice::Impl::set_integer(const std::string& where, const char* feature,
                                     const std::string& value) const {
    const auto number = parsed_number<gint64>(value);
    if (!number) throw InputError(where, fmt::format("needs an integer, but is \"{}\"", value));
    GlibError error;
    arv_device_set_integer_feature_value(device, feature, *number, error.slot());
    error.check_answer(where);
    if (error.any())
        throw InputError(where, fmt::format("{} cannot be set ({}){}", value, error.text(),
                                            range_of(device, feature)));
    check->check_lengths();
    const gint64 back = arv_device_get_integer_feature_value(device, feature, nullptr);
    if (back != *number)
        throw DeviceError(where, fmt::format("asked for {}, the camera made it {}; ask for that if "
                                             "it will do",
                                             *number, back));
}

void AravisDevice::Impl::set_other(const std::string& where, const char* feature,
                                   const std::string& value) const {
    GlibError error;
    ArvGcNode* node = arv_device_get_feature(device, feature);
    if (ARV_IS_GC_BOOLEAN(node)) {
        const bool on = value == "true" || value == "1";
        if (!on && value != "false" && value != "0")
            throw InputError(where, fmt::format("needs true or false, but is \"{}\"", value));
        arv_device_set_boolean_feature_value(device, feature, on ? TRUE : FALSE, error.slot());
    } else if (ARV_IS_GC_COMMAND(node)) {
        arv_device_execute_command(device, feature, error.slot());
    } else if (ARV_IS_GC_FLOAT(node)) {
        const auto number = parsed_number<double>(value);
        if (!number) throw InputError(where, fmt::format("needs a number, but is \"{}\"", value));
        arv_device_set_float_feature_value(device, feature, *number, error.slot());
    } else {
        arv_device_set_string_feature_value(device, feature, value.c_str(), error.slot());
    }
    error.check_answer(where);
    if (error.any()) throw InputError(where, error.text());
}

std::string AravisDevice::nearest_feature(const std::string& name) const {
    std::vector<std::string> known;
    for (const auto& [feature, value] : features()) known.push_back(feature);
    const std::string nearest = nearest_name(name, known);
    return nearest.empty() ? "\"stipple capture features ADDRESS\" lists those that it has"
                           : fmt::format("did you mean \"{}\"?", nearest);
}

void AravisDevice::set(const std::string& feature, const std::string& value) {
    impl_->check->check_lengths();
    const std::string where = fmt::format("{}: {}", address_, feature);
    const auto* const known = std::find_if(
        kNumbers.begin(), kNumbers.end(), [&](const auto& entry) { return feature == entry.name; });
    if (known != kNumbers.end() && known->is_available(impl_->camera, nullptr) != FALSE)
        return impl_->set_number(where, *known, value);
    ArvGcNode* node = arv_device_get_feature(impl_->device, feature.c_str());
    if (node == nullptr || ARV_IS_GC_FEATURE_NODE(node) == FALSE || ARV_IS_GC_CATEGORY(node))
        throw InputError(where, "the camera has no such feature; " + nearest_feature(feature));
    if (ARV_IS_GC_ENUMERATION(node)) return impl_->set_choice(where, feature.c_str(), value);
    if (ARV_IS_GC_INTEGER(node) && !ARV_IS_GC_BOOLEAN(node))
        return impl_->set_integer(where, feature.c_str(), value);
    impl_->set_other(where, feature.c_str(), value);
}

std::vector<FeatureName> AravisDevice::feature_names() const {
    std::vector<FeatureName> found;
    std::vector<std::string> categories{"Root"};
    std::set<std::string> seen{"Root"};  // a category may name itself
    for (std::size_t next = 0; next < categories.size(); ++next) {
        const std::string inside = categories[next];
        ArvGcNode* category = arv_device_get_feature(impl_->device, inside.c_str());
        if (category == nullptr || !ARV_IS_GC_CATEGORY(category)) continue;
        const GSList* names = arv_gc_category_get_features(ARV_GC_CATEGORY(category));
        for (; names != nullptr; names = names->next) {
            std::string name(static_cast<const char*>(names->data));
            if (seen.size() == kMaxFeatures) return found;
            if (!seen.insert(name).second) continue;
            ArvGcNode* node = arv_device_get_feature(impl_->device, name.c_str());
            if (node != nullptr && ARV_IS_GC_CATEGORY(node))
                categories.push_back(std::move(name));
            else if (node != nullptr)
                found.push_back({std::move(name), inside});
        }
    }
    return found;
}

std::map<std::string, std::string> AravisDevice::features() const {
    std::map<std::string, std::string> found;
    for (const FeatureName& feature : feature_names())
        if (const auto value = read(feature.name)) found.emplace(feature.name, *value);
    return found;
}

std::string AravisDevice::genicam_xml() const {
    std::size_t size = 0;
    const char* xml = arv_device_get_genicam_xml(impl_->device, &size);
    return xml == nullptr ? std::string() : std::string(xml, size);
}

void apply_settings(AravisDevice& device, const CameraSettings& settings) {
    static constexpr std::array<std::string_view, 5> kFirst{"PixelFormat", "Width", "Height",
                                                            "OffsetX", "OffsetY"};
    const auto asked = [&](std::string_view name) {
        return std::find_if(settings.rbegin(), settings.rend(),
                            [&](const auto& setting) { return setting.first == name; });
    };
    if (asked("Width") != settings.rend() || asked("Height") != settings.rend())
        for (const char* offset : {"OffsetX", "OffsetY"})
            if (device.read(offset).value_or("0") != "0") device.set(offset, "0");
    for (const std::string_view name : kFirst)
        if (const auto found = asked(name); found != settings.rend())
            device.set(found->first, found->second);
    for (const auto& [name, value] : settings)
        if (std::find(kFirst.begin(), kFirst.end(), name) == kFirst.end()) device.set(name, value);
}

}  // namespace stipple
