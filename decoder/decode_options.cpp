#include "decoder/decode_options.h"

namespace stipple {

DecodeOptions read_decode_options(DecodeMethod method, Config& config) {
    DecodeOptions options{.method = method};
    named(method).read_options(config, options);
    config.reject_unknown_keys();
    return options;
}

}  // namespace stipple
