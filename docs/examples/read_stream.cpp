// The samples of a stream, slot by slot: read_stream CLIP.stipple
#include <stipple/stream.h>

#include <iostream>

int main(int argc, char** argv) try {
    if (argc != 2) throw std::invalid_argument("usage: read_stream CLIP.stipple");
    stipple::StreamReader stream(argv[1]);
    const auto& header = stream.header();
    stipple::SamplePacket packet;
    while (stream.next(packet)) {
        auto dn = packet.dn.begin();
        double sum = 0, slots = 0;  // of the samples, and of the slots that they collected light in
        for (int row = packet.first_row; row < packet.first_row + packet.rows; ++row)
            stipple::visit_due_pixels(header.schedule, packet.slot, row, header.shape.cols,
                                      [&](int, const stipple::DuePixel& pixel) {
                                          for (int plane = 0; plane < header.shape.planes; ++plane)
                                              sum += *dn++;
                                          slots += pixel.light_slots * header.shape.planes;
                                      });
        std::cout << "slot " << packet.slot << ": " << packet.dn.size() << " samples, "
                  << sum / slots << " DN a slot of light\n";
    }
    for (const auto& damage : stream.report().damage)
        std::cerr << damage.offset << ": " << damage.cause << "\n";
} catch (const std::exception& error) {
    std::cerr << error.what() << "\n";
    return 1;
}
