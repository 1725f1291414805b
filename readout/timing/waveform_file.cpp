#include "readout/timing/waveform_file.h"

#include <cstddef>
#include <span>

#include "io/output_file.h"
#include "readout/timing/waveform.h"

namespace stipple {

void WaveformFile::write(ReadoutCost& cost, const std::string& sensor, SlotRange range,
                         const std::function<bool()>& keep_going) {
    OutputFile file(output_.partial(), output_.final_path().string());
    const auto write = [&](const std::string& text) { file.write(std::as_bytes(std::span(text))); };
    Waveform waveform(cost.timing(), sensor);
    write(waveform.head());
    std::int64_t begin = 0;
    for (std::int64_t slot = range.first; slot < range.first + range.slots && keep_going();
         ++slot) {
        write(waveform.slot(cost, slot, begin));
        begin += cost.of(slot).clocks;
    }
    write(waveform.tail(begin));
    file.close();
    output_.commit();
}

}  // namespace stipple
