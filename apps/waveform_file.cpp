#include "apps/waveform_file.h"

#include <cstddef>
#include <span>

#include "apps/interrupt.h"
#include "io/output_file.h"
#include "readout/timing/waveform.h"

namespace stipple {

void WaveformFile::write(ReadoutAccount& account, const std::string& sensor,
                         std::int64_t first_slot, std::int64_t slots) {
    OutputFile file(output_.partial(), output_.final_path().string());
    const auto write = [&](const std::string& text) { file.write(std::as_bytes(std::span(text))); };
    Waveform waveform(account.timing(), sensor);
    write(waveform.head());
    std::int64_t begin = 0;
    for (std::int64_t slot = first_slot; slot < first_slot + slots && stop_signal() == 0; ++slot) {
        write(waveform.slot(account, slot, begin));
        begin += account.of(slot).clocks;
    }
    write(waveform.tail(begin));
    file.close();
    output_.commit();
}

}  // namespace stipple
