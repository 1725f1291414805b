// Aravis' own fake GigE Vision camera, which shares no code with our server, in a process of its
// own, so that it can be killed: fake_gige_camera NAME=NUMBER ...
//   address (last byte of 127.0.0.x, 1), width, height, format (PFNC code), period_us, first_id,
//   genicam=FILE (its XML, of Aravis' own make if there is none)
//   gap_at and gap (ids that it leaves out after so many frames), lost_permille (packets)
// Prints READY. A line "ADDRESS VALUE" on standard input writes a register, which prints DONE; end
// of input ends it.
#include <arv.h>

#include <atomic>
#include <cstdio>
#include <iostream>
#include <map>
#include <string>

#include "tests/capture/fake_frame.h"

namespace {

std::map<std::string, long> options;

long option(const char* name, long fallback) {
    const auto found = options.find(name);
    return found == options.end() ? fallback : found->second;
}

/// Called for each frame that is sent: pixels, id and stamp as tests/capture/fake_frame.h has them.
void fill(ArvBuffer* buffer, void*, guint32, guint32, ArvPixelFormat format) {
    static std::atomic<long> sent = 0;
    long number = sent++;
    if (number >= option("gap_at", 1L << 40)) number += option("gap", 0);
    const long id = (option("first_id", 1) - 1 + number) % 65535 + 1;
    const auto bits = static_cast<std::size_t>(ARV_PIXEL_FORMAT_BIT_PER_PIXEL(format));
    const auto pixels = static_cast<std::size_t>(arv_buffer_get_image_width(buffer)) *
                        static_cast<std::size_t>(arv_buffer_get_image_height(buffer));
    std::size_t unused = 0;
    auto* bytes =
        static_cast<std::uint8_t*>(const_cast<void*>(arv_buffer_get_data(buffer, &unused)));
    stipple::fill_fake_frame({bytes, pixels * bits / 8}, static_cast<std::uint64_t>(id));
    arv_buffer_set_frame_id(buffer, static_cast<guint64>(id));
    arv_buffer_set_timestamp(buffer, stipple::fake_stamp_ns(static_cast<std::uint64_t>(number)));
}

void write_register(ArvFakeCamera* camera, guint32 address, long value) {
    arv_fake_camera_write_register(camera, address, static_cast<guint32>(value));
}

}  // namespace

int main(int argc, char** argv) {
    const char* genicam = nullptr;
    for (int i = 1; i < argc; ++i) {
        const std::string text(argv[i]);
        const auto equals = text.find('=');
        if (text.starts_with("genicam="))
            genicam = argv[i] + equals + 1;
        else
            options[text.substr(0, equals)] = std::stol(text.substr(equals + 1), nullptr, 0);
    }
    const std::string address = "127.0.0." + std::to_string(option("address", 1));
    ArvGvFakeCamera* server = arv_gv_fake_camera_new_full(address.c_str(), "TEST", genicam);
    if (arv_gv_fake_camera_is_running(server) == FALSE) return 1;
    g_object_set(server, "gvsp-lost-ratio", static_cast<double>(option("lost_permille", 0)) / 1000,
                 nullptr);
    ArvFakeCamera* camera = arv_gv_fake_camera_get_fake_camera(server);
    write_register(camera, ARV_FAKE_CAMERA_REGISTER_WIDTH, option("width", 64));
    write_register(camera, ARV_FAKE_CAMERA_REGISTER_HEIGHT, option("height", 48));
    write_register(camera, ARV_FAKE_CAMERA_REGISTER_PIXEL_FORMAT, option("format", 0x01080001));
    write_register(camera, ARV_FAKE_CAMERA_REGISTER_ACQUISITION_FRAME_PERIOD_US,
                   option("period_us", 5000));
    arv_fake_camera_set_fill_pattern(camera, fill, nullptr);
    std::puts("READY");
    std::fflush(stdout);
    guint32 where = 0;
    for (long value = 0; std::cin >> where >> value;) {
        write_register(camera, where, value);
        std::puts("DONE");
        std::fflush(stdout);
    }
    g_object_unref(server);
}
