#pragma once

#include <filesystem>
#include <string>

#include "tests/support/temporary_folder.h"

namespace stipple {

/// A file that describes a camera, with these nodes and the port, as long as it lives.
class GenicamFile {
  public:
    explicit GenicamFile(const std::string& nodes) {
        write_text(path(),
                   "<?xml version=\"1.0\"?>\n<RegisterDescription ModelName=\"Described\" "
                   "VendorName=\"Test\" StandardNameSpace=\"None\" SchemaMajorVersion=\"1\" "
                   "SchemaMinorVersion=\"0\" SchemaSubMinorVersion=\"0\" MajorVersion=\"1\" "
                   "MinorVersion=\"0\" SubMinorVersion=\"0\" "
                   "xmlns=\"http://www.genicam.org/GenApi/Version_1_0\">\n" +
                       nodes + "<Port Name=\"Device\"></Port>\n</RegisterDescription>\n");
    }
    [[nodiscard]] std::filesystem::path path() const { return folder_ / "genicam.xml"; }

  private:
    TemporaryFolder folder_;
};

}  // namespace stipple
