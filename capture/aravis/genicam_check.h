#pragma once

#include <string>
#include <vector>

namespace stipple {

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

}  // namespace stipple
