#pragma once

/// Light through a sensor, to a sample stream:
///
///     stipple::FootageReader footage("scene.npy");
///     const auto sensor = stipple::set_up_sensor({.sensor = "lux1310"}, footage.shape());
///     stipple::StreamRecorder recorder("clip.stipple", sensor, {.force = true});
///     std::vector<float> light(footage.shape().sites());
///     while (footage.read(light)) recorder.expose(light);
///     recorder.finish();
///     std::cout << recorder.samples() << " samples\n";
///
/// Emulator gives the packets alone, without a file. EmulationSource makes slots of footage at any
/// frame rate; emulate_pieces shares the work between processes (docs/scaling.md).
#include "readout/emulator.h"
#include "readout/provenance.h"
#include "readout/stream_recorder.h"
#include "session/stream_shards.h"
#include "stipple/sensor.h"
#include "stipple/video.h"
