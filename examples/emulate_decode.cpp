// Footage through an emulated sensor and back: emulate_decode LIGHT.npy OUT.npy
#include <stipple/decoder/reconstruct.h>
#include <stipple/io/footage_reader.h>
#include <stipple/io/npy_writer.h>
#include <stipple/readout/sensor_file.h>
#include <stipple/readout/stream_recorder.h>

#include <iostream>
#include <vector>

int main(int argc, char** argv) try {
    if (argc != 3) throw std::invalid_argument("usage: emulate_decode LIGHT.npy OUT.npy");
    stipple::FootageReader footage(argv[1]);
    const auto sensor =
        stipple::set_up_sensor({.sensor = "lux1310", .schedule = "random"}, footage.shape());

    stipple::StreamRecorder recorder("coded.stipple", sensor, {.force = true});
    std::vector<float> frame(footage.shape().sites());
    while (footage.read(frame)) recorder.expose(frame);
    recorder.finish();
    std::cout << recorder.samples() << " samples, compression " << recorder.compression_ratio()
              << "\n";

    stipple::StreamReader stream("coded.stipple");
    stipple::NpyWriter out(argv[2], argv[2], footage.shape());
    stipple::decode(stream, stipple::DecodeMethod::kFast,
                    [&](std::int64_t, std::span<const float> light) {
                        out.write(light);
                        return true;
                    });
    out.finish();
} catch (const std::exception& error) {
    std::cerr << error.what() << "\n";
    return 1;
}
