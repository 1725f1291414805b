#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "capture/camera.h"
#include "capture/camera_search.h"

namespace stipple {

/// A feature, and the category that lists it.
struct FeatureName {
    std::string name;
    std::string category;
};

/// The control channel of a GenICam camera: access, features, identity.
class AravisDevice {
  public:
    /// `address` as for open_aravis_camera. \throws InputError, DeviceError.
    explicit AravisDevice(const std::string& address);
    /// Takes `device`, an open ArvDevice. \throws DeviceError.
    AravisDevice(std::string address, void* device);
    ~AravisDevice();
    AravisDevice(const AravisDevice&) = delete;
    AravisDevice& operator=(const AravisDevice&) = delete;

    [[nodiscard]] const std::string& address() const { return address_; }
    [[nodiscard]] bool is_gige() const;
    /// GigE: whether this program, and no other, controls the camera.
    [[nodiscard]] bool is_controller() const;
    /// GigE: "IP:port" of the program that controls the camera, if the camera tells.
    [[nodiscard]] std::string controller() const;

    /// \throws DeviceError if values of the camera have made its registers too long
    /// (GenicamCheck); the same holds for `read` and `set`.
    [[nodiscard]] bool has(const std::string& feature) const;
    /// Value as text; empty if the feature does not exist or cannot be read.
    [[nodiscard]] std::optional<std::string> read(const std::string& feature) const;
    [[nodiscard]] std::optional<double> read_number(const std::string& feature) const;
    /// Sets a feature and reads it back. For older cameras ExposureTime, Gain, BlackLevel and
    /// AcquisitionFrameRate are translated to their names.
    /// \throws InputError if the feature does not exist, or the text is no value or out of range;
    /// DeviceError if the camera refuses or sets another value.
    void set(const std::string& feature, const std::string& value);
    /// The first 20 000 names under Root without those of categories, by category; each once.
    [[nodiscard]] std::vector<FeatureName> feature_names() const;
    /// Values of those that can be read.
    [[nodiscard]] std::map<std::string, std::string> features() const;
    [[nodiscard]] std::string genicam_xml() const;

    /// The ArvCamera, for the other sources of this module.
    [[nodiscard]] void* native() const;

  private:
    struct Impl;
    /// Advice for a name that is no feature.
    [[nodiscard]] std::string nearest_feature(const std::string& name) const;

    std::string address_;
    std::unique_ptr<Impl> impl_;
};

/// The features of `feature_names` with types, values and ranges.
[[nodiscard]] std::vector<CameraFeature> describe_features(const AravisDevice& device);

/// Applies settings in the order that cameras accept: offsets to 0, format and size, offsets, then
/// the others in the given order. \throws InputError, DeviceError as set.
void apply_settings(AravisDevice& device, const CameraSettings& settings);

}  // namespace stipple
