#include "tests/study/report/recorded_clip.h"

#include <openssl/evp.h>
#include <zlib.h>

#include <algorithm>
#include <stdexcept>

#include "readout/provenance.h"
#include "readout/sensor_file.h"
#include "readout/stream_recorder.h"

namespace stipple {

void record_clip(const std::filesystem::path& file, const SensorChoice& choice,
                 const FluxVideo& light) {
    const SensorSetup setup = set_up_sensor(choice, light.shape());
    StreamRecorder recorder(file, setup, {.provenance = provenance_of(setup, {.name = "ramp"})});
    for (int slot = 0; slot < light.slots(); ++slot) recorder.expose(light.frame(slot));
    recorder.finish();
}

std::vector<std::uint16_t> unpacked_plane(const std::string& text, std::size_t step) {
    std::vector<unsigned char> packed(text.size());
    const int length =
        EVP_DecodeBlock(packed.data(), reinterpret_cast<const unsigned char*>(text.data()),
                        static_cast<int>(text.size()));
    if (length < 0) throw std::runtime_error("no base64");
    std::vector<unsigned char> bytes(std::size_t{1} << 22U);
    uLongf count = bytes.size();
    // The zeros for which the padding stands are behind the end of the data.
    if (uncompress(bytes.data(), &count, packed.data(), static_cast<uLong>(length)) != Z_OK)
        throw std::runtime_error("no zlib data");
    std::vector<std::uint16_t> values(count / 2);
    for (std::size_t i = 0; i < values.size(); ++i) {
        const int folded = bytes[i] + 256 * bytes[values.size() + i];
        const int difference = folded % 2 == 0 ? folded / 2 : -(folded + 1) / 2;
        const int before = i < step ? 0 : values[i - step];
        values[i] = static_cast<std::uint16_t>(before + difference);
    }
    return values;
}

}  // namespace stipple
