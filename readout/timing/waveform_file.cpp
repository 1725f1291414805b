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
    cost.begin_at(range.first);
    for (std::int64_t i = 0; i < range.slots && keep_going(); ++i) write(waveform.add_slot(cost));
    write(waveform.tail(cost.clocks()));
    file.close();
    output_.commit();
}

}  // namespace stipple
