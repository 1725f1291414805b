// Footage through an emulated sensor and back: emulate_decode LIGHT.npy OUT.npy
#include <stipple/decode.h>
#include <stipple/emulate.h>

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

    stipple::DecodeSession session("coded.stipple",
                                   {.options = {.method = stipple::DecodeMethod::kFast}});
    stipple::FrameWriter out(argv[2], session.shape(), {.force = true});
    session.run([&](std::int64_t, std::span<const float> light) {
        out.write(light);
        return true;
    });
    out.finish();
} catch (const std::exception& error) {
    std::cerr << error.what() << "\n";
    return 1;
}
