#pragma once

#include <cstdint>

#include "core/config.h"
#include "decoder/best/collaborative.h"
#include "decoder/conventional/bennett2005.h"
#include "decoder/conventional/shahar2011.h"
#include "decoder/conventional/vbm4d.h"
#include "decoder/conventional/zhang2009.h"
#include "decoder/decode_method.h"
#include "decoder/fast/motion_tv.h"
#include "decoder/hitomi2011/hitomi2011.h"
#include "decoder/learned/learned.h"
#include "decoder/plug_and_play/plug_and_play.h"
#include "decoder/portz2013/portz2013.h"
#include "decoder/reddy2011/reddy2011.h"
#include "decoder/stage_observer.h"

namespace stipple {

/// A method and the options of all methods; only those of `method` are used.
struct DecodeOptions {
    DecodeMethod method = DecodeMethod::kBest;
    MotionTvOptions fast = {};       ///< of `learned_fast` too
    CollaborativeOptions best = {};  ///< of `learned` and `plug_and_play` too
    LearnedOptions learned = {};     ///< of `learned_fast` too
    PlugAndPlayOptions plug_and_play = {};
    Portz2013Options portz2013 = {};
    Reddy2011Options reddy2011 = {};
    Hitomi2011Options hitomi2011 = {};
    Bennett2005Options bennett2005 = {};
    Zhang2009Options zhang2009 = {};
    Vbm4dOptions vbm4d = {};
    Shahar2011Options shahar2011 = {};
    StageSink stages = {};
    bool fill_gaps = false;  ///< decode missing slots, whatever their number
    /// The first frame, where a block begins (block_begin); those before are not decoded. The
    /// others have the same bits as without.
    std::int64_t first_slot = 0;
};

/// The method with the options of `config`, whose keys are those of `stipple list keys decoder` for
/// this method. \throws InputError for an unknown key, a wrong type or a value out of range.
[[nodiscard]] DecodeOptions read_decode_options(DecodeMethod method, Config& config);

}  // namespace stipple
