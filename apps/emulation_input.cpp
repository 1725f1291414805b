#include "apps/emulate.h"

#include "apps/standard_streams.h"
#include "capture/recording/footage_notes.h"

namespace stipple {

EmulationInput::EmulationInput(const EmulateArguments& arguments)
    : footage_(arguments.source.open([](const Message& warning) { say_warning(warning); })),
      setup_(set_up_sensor(arguments.sensor, footage_.shape(), footage_.filter())),
      slots_(arguments.source.slots_of(footage_, setup_.params.slot_us)) {
    if (setup_.params.slot_us < 1)
        say_warning("slots of {:g} us are {:.3g} a second; is slot_us in microseconds?",
                    setup_.params.slot_us, 1e6 / setup_.params.slot_us);
    say_warning(mosaic_warning(setup_, footage_.filter()));
    for (const Message& note : sensor_notes(arguments.source.footage, footage_, setup_.params,
                                            arguments.source.resampling.has_value()))
        say_warning(note);
}

}  // namespace stipple
