#include "session/rig_folder.h"

#include <fmt/format.h>

#include "core/config.h"
#include "core/error.h"
#include "readout/footage_origin.h"
#include "readout/provenance.h"

namespace stipple {
namespace {

namespace fs = std::filesystem;

/// \throws InputError if the stream is not the one that belongs to the sensor.
void check_stream(const RigSensor& sensor, const StreamReader& reader, const StreamReader& first,
                  const std::function<void()>& check) {
    const std::string footage = footage_of(reader.header().provenance);
    const std::string wanted = footage_of(first.header().provenance);
    if (!footage.empty() && !wanted.empty() && footage != wanted)
        throw InputError(reader.name(),
                         fmt::format("is of other footage than {}; a rig has streams of one scene",
                                     first.name()));
    if (sensor.sha256.empty()) return;
    if (origin_of(reader.name(), {}, check).sha256 != sensor.sha256)
        throw InputError(reader.name(),
                         fmt::format("is not the stream that {} names (its sha256 differs): it is "
                                     "of another rig or run, or damaged; without the key {}.sha256 "
                                     "it is taken as it is",
                                     kRigFile, sensor.name));
}

}  // namespace

std::vector<RigStream> RigFolder::streams() {
    std::vector<RigStream> streams;
    for (std::size_t i = 0; i < readers.size(); ++i)
        streams.push_back(
            {readers[i], {rig.sensors[i].from_reference, rig.sensors[i].phase_slots}});
    return streams;
}

bool is_rig_folder(const fs::path& path) {
    std::error_code error;
    return fs::is_regular_file(path / kRigFile, error);
}

RigFolder open_rig_folder(const fs::path& folder, ReadPolicy policy,
                          const std::function<void()>& check) {
    Config config(folder / kRigFile, {});
    RigFolder opened{.rig = read_rig(config), .readers = {}};
    for (const RigSensor& sensor : opened.rig.sensors) {
        const fs::path file = folder / sensor.file();
        if (!fs::is_regular_file(file))
            throw InputError(
                file.string(),
                fmt::format("is missing or not a file; {} names it as the stream of sensor \"{}\"",
                            (folder / kRigFile).string(), sensor.name));
        opened.readers.emplace_back(file, policy);
        check_stream(sensor, opened.readers.back(), opened.readers.front(), check);
    }
    return opened;
}

}  // namespace stipple
