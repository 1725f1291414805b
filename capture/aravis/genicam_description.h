#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace stipple {

/// The file that Aravis takes from a zip file: the last one of its directory. Empty if part of the
/// directory or of a file lies outside of `zip`, or a file has more than `max_bytes`.
[[nodiscard]] std::optional<std::vector<std::uint8_t>> unzipped_description(
    std::span<const std::uint8_t> zip, std::size_t max_bytes);

/// A register of a camera, an ArvGcRegister.
struct GenicamRegister {
    void* node;
    std::string name;
};

/// What Aravis (0.8.26) would not survive in the GenICam description of a camera: it would not
/// terminate, or ask for memory without limit.
class GenicamCheck {
  public:
    /// Checks the description of the ArvDevice `device`, which must outlive this. \throws
    /// DeviceError at `address` if the XML is not well-formed, if the value of a feature depends on
    /// itself, or on others in more than 1000 ways; and as check_lengths.
    GenicamCheck(void* device, std::string address);

    /// To be called before values are read: the length of a register may depend on values of the
    /// camera. \throws DeviceError if the registers together have more than 4 MiB, or a negative
    /// length.
    void check_lengths() const;

  private:
    void check(const std::vector<GenicamRegister>& registers) const;

    std::string address_;
    std::vector<GenicamRegister> variable_;  ///< with a pLength, in an order to evaluate them
};

/// Reads the GenICam description of a GigE Vision camera as Aravis will when it opens the camera,
/// but within limits: Aravis (0.8.26) trusts the size and the place that a camera names, and the
/// offsets in a zip file. `ip` in host byte order. \throws DeviceError at `address`: nothing
/// answers, or the description is not in the camera, too large, damaged or not XML.
void check_genicam_download(const std::string& address, std::uint32_t ip);

}  // namespace stipple
