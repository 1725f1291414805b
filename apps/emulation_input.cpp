#include "apps/emulation_input.h"

#include "apps/interrupt.h"
#include "apps/standard_error.h"
#include "capture/recording/footage_notes.h"
#include "core/error.h"
#include "decoder/motion/lazy_opencv.h"
#include "readout/footage_origin.h"

namespace stipple {
EmulationInput::EmulationInput(const EmulateArguments& arguments)
    : footage_(read_footage(arguments.footage, arguments.reading)),
      setup_(set_up_sensor(arguments.sensor, footage_.shape(), footage_.filter())),
      slots_(slots_of(footage_, arguments, setup_.params.slot_us)) {
    if (setup_.params.slot_us < 1)
        say_warning("slots of {:g} us are {:.3g} a second; is slot_us in microseconds?",
                    setup_.params.slot_us, 1e6 / setup_.params.slot_us);
    say_warning(mosaic_warning(setup_, footage_.filter()));
    for (const Message& note :
         sensor_notes(arguments.footage, footage_, setup_.params, arguments.resampling.has_value()))
        say_warning(note);
}

ResampledFootage slots_of(ReadAhead& footage, const EmulateArguments& arguments, double slot_us) {
    return {footage,
            arguments.footage,
            {.method = arguments.resampling,
             .frames_hz = arguments.reading.frames_hz,
             .slot_us = slot_us,
             .flow = dis_flow,
             .min_flow_side = kMinDisFlowSide}};
}

FootageOrigin footage_origin(const EmulateArguments& arguments) {
    FootageOrigin origin =
        origin_of(arguments.footage, arguments.reading, [] { throw_if_stopped(); });
    if (arguments.resampling) origin.resample = name_in(kResamplings, *arguments.resampling);
    return origin;
}

void refuse_short_footage(const std::string& footage) {
    throw InputError(footage, "is shorter than a slot of the sensor");
}

}  // namespace stipple
