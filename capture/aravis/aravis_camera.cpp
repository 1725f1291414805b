#include "capture/aravis/aravis_camera.h"

#include <arv.h>
#include <fmt/format.h>

#include "capture/aravis/aravis_call.h"
#include "capture/aravis/aravis_device.h"
#include "capture/aravis/aravis_stream.h"
#include "capture/frame_payload.h"
#include "core/error.h"
#include "core/geometry.h"
#include "core/text.h"

namespace stipple {
namespace {

/// GVSP block ids are 1 to 65535, and begin with 1 when the stream channel is opened.
constexpr std::uint64_t kGigeIdPeriod = 65535;
constexpr std::uint64_t kGigeFirstId = 1;
constexpr std::uint64_t kUsbIdPeriod = ~std::uint64_t{0};

std::string formats_we_read() {
    std::string text;
    for (const PixelFormat& format : pixel_formats())
        text += fmt::format("{}{}", text.empty() ? "" : ", ", format.name);
    return text;
}

std::uint64_t hash_of(const std::string& text) {
    return payload_hash(std::vector<std::uint8_t>(text.begin(), text.end()));
}

int read_int(const AravisDevice& device, const char* feature, int fallback) {
    return static_cast<int>(device.read_number(feature).value_or(fallback));
}

/// What the camera is set to send.
FrameLayout layout_of(const AravisDevice& device) {
    auto* camera = static_cast<ArvCamera*>(device.native());
    GlibError error;
    const auto code = static_cast<std::uint32_t>(arv_camera_get_pixel_format(camera, error.slot()));
    error.check_answer(device.address());
    FrameLayout layout;
    layout.format = pixel_format_of_pfnc(code);
    if (layout.format == nullptr)
        throw InputError(
            fmt::format("{}: PixelFormat", device.address()),
            fmt::format("{} (0x{:08x}) is not read; set one of {}",
                        device.read("PixelFormat").value_or("?"), code, formats_we_read()));
    layout.width = read_int(device, "Width", 0);
    layout.height = read_int(device, "Height", 0);
    layout.offset_x = read_int(device, "OffsetX", 0);
    layout.offset_y = read_int(device, "OffsetY", 0);
    if (layout.width <= 0 || layout.height <= 0 || layout.width > kMaxFrameSide ||
        layout.height > kMaxFrameSide)
        throw DeviceError(device.address(), fmt::format("says that its frames have {} x {} pixels",
                                                        layout.width, layout.height));
    if (layout.width * layout.format->bits_per_pixel % 8 != 0)
        throw InputError(fmt::format("{}: Width", device.address()),
                         fmt::format("rows of {} pixels of {} do not end with a byte; choose a "
                                     "multiple of 4",
                                     layout.width, layout.format->name));
    layout.stride_bytes = layout.format->row_bytes(layout.width);
    return layout;
}

/// The packet size of a GigE Vision camera is a register of the standard, feature or not.
constexpr std::string_view kPacketSize = "GevSCPSPacketSize";

int packet_bytes_of(const std::string& address, const std::string& text) {
    const auto bytes = parsed_number<int>(text);
    if (!bytes || *bytes < 220 || *bytes > 65500)
        throw InputError(fmt::format("{}: {}", address, kPacketSize),
                         fmt::format("\"{}\" is not a number from 220 to 65500", text));
    return *bytes;
}

class AravisCamera : public Camera {
  public:
    AravisCamera(const std::string& address, const CameraSettings& settings,
                 const CameraBuffers& buffers)
        : device_(address) {
        if (!device_.is_controller()) {
            const std::string who = device_.controller();
            throw DeviceError(address,
                              fmt::format("another program{} controls the camera: stop it, or wait "
                                          "some seconds if it has crashed",
                                          who.empty() ? "" : fmt::format(" ({})", who)));
        }
        CameraSettings features;
        std::optional<int> packet_bytes;
        for (const auto& setting : settings)
            if (setting.first == kPacketSize && device_.is_gige())
                packet_bytes = packet_bytes_of(address, setting.second);
            else
                features.push_back(setting);
        apply_settings(device_, features);
        stream_ =
            std::make_unique<AravisStream>(device_, layout_of(device_), buffers, packet_bytes);
        read_exposure();
        features_ = all_features(settings);
        xml_hash_ = fmt::format("{:016x}", hash_of(device_.genicam_xml()));
    }

    [[nodiscard]] CameraDescription description() const override;
    [[nodiscard]] FrameLayout layout() const override { return stream_->layout(); }
    [[nodiscard]] std::size_t buffer_bytes() const override { return stream_->buffer_bytes(); }
    [[nodiscard]] std::uint64_t wire_id_period() const override {
        return device_.is_gige() ? kGigeIdPeriod : kUsbIdPeriod;
    }
    [[nodiscard]] std::optional<StreamStart> stream_start() const override {
        if (!device_.is_gige()) return {};
        return StreamStart{kGigeFirstId, stream_->started_ns()};
    }
    [[nodiscard]] TransportCounts counts() const override { return stream_->counts(); }
    void start() override { stream_->start(); }
    [[nodiscard]] Arrival wait(std::chrono::milliseconds timeout) override;
    void stop() noexcept override { stream_->stop(); }
    void set(const std::string& feature, const std::string& value) override;

  private:
    void read_exposure();

    AravisDevice device_;
    std::unique_ptr<AravisStream> stream_;
    std::optional<double> exposure_us_;
    std::optional<double> gain_;
    std::optional<double> black_level_dn_;
    [[nodiscard]] std::map<std::string, std::string> all_features(
        const CameraSettings& settings) const;

    std::map<std::string, std::string> features_;
    std::string xml_hash_;
};

/// Those that the camera lists, and those that it has without listing them.
std::map<std::string, std::string> AravisCamera::all_features(
    const CameraSettings& settings) const {
    std::map<std::string, std::string> found = device_.features();
    const auto add = [&](const std::string& name) {
        if (const auto value = device_.read(name)) found.emplace(name, *value);
    };
    for (const auto* name : {"AcquisitionFrameRate", "ExposureTime", "Gain", "GainRaw", "GainAuto",
                             "BlackLevel", "TriggerMode"})
        add(name);
    for (const auto& [name, value] : settings) add(name);
    return found;
}

CameraDescription AravisCamera::description() const {
    const auto read = [&](const char* name) { return device_.read(name).value_or(""); };
    CameraDescription text;
    text.transport = device_.is_gige() ? "GigE Vision" : "USB3 Vision";
    text.address = device_.address();
    text.vendor = read("DeviceVendorName");
    text.model = read("DeviceModelName");
    text.serial = read("DeviceSerialNumber");
    if (text.serial.empty()) text.serial = read("DeviceID");
    text.firmware = read("DeviceFirmwareVersion");
    if (text.firmware.empty()) text.firmware = read("DeviceVersion");
    text.genicam_xml_hash = xml_hash_;
    text.features = features_;
    text.transport_facts = stream_->facts();
    text.transport_facts["aravis"] = fmt::format("{}.{}.{}", arv_get_major_version(),
                                                 arv_get_minor_version(), arv_get_micro_version());
    text.warnings = stream_->warnings();
    return text;
}

void AravisCamera::read_exposure() {
    const auto first_of = [&](const char* name, const char* older) {
        const auto value = device_.read_number(name);
        return value ? value : device_.read_number(older);
    };
    exposure_us_ = first_of("ExposureTime", "ExposureTimeAbs");
    gain_ = first_of("Gain", "GainRaw");
    black_level_dn_ = first_of("BlackLevel", "BlackLevelRaw");
}

void AravisCamera::set(const std::string& feature, const std::string& value) {
    device_.set(feature, value);
    features_[feature] = device_.read(feature).value_or(value);
    read_exposure();
}

Arrival AravisCamera::wait(std::chrono::milliseconds timeout) {
    Arrival arrival = stream_->wait(timeout, pool());
    if (auto* frame = std::get_if<CapturedFrame>(&arrival)) {
        FrameRecord& record = frame->record;
        if (!record.exposure_us) record.exposure_us = exposure_us_;
        if (!record.gain) record.gain = gain_;
        if (!record.black_level_dn) record.black_level_dn = black_level_dn_;
    }
    return arrival;
}

}  // namespace

std::unique_ptr<Camera> open_aravis_camera(const std::string& address,
                                           const CameraSettings& settings,
                                           const CameraBuffers& buffers) {
    return within_limited_time(address, [=]() -> std::unique_ptr<Camera> {
        return std::make_unique<AravisCamera>(address, settings, buffers);
    });
}

}  // namespace stipple
