#pragma once

/// The sample stream (docs/stream_format.md), packet by packet:
///
///     stipple::StreamReader stream("clip.stipple");
///     stipple::SamplePacket packet;
///     std::uint64_t samples = 0;
///     while (stream.next(packet)) samples += packet.dn.size();
///     std::cout << stream.header().shape.cols << " pixels a row, " << samples << " samples, "
///               << stream.report().damage.size() << " damaged places\n";
///
/// for_each_readout tells the pixel and the exposure of each sample; StreamWriter writes a stream.
/// A stream of version 4 may change its schedule: follow_switches, and schedule_switch.h.
#include "stream/schedule_switch.h"
#include "stream/stream_figures.h"
#include "stream/stream_reader.h"
#include "stream/stream_writer.h"
