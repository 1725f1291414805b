#pragma once

#include <string>
#include <string_view>

#include "readout/program/sequencer_program.h"

namespace stipple {

/// A program and its name in a file.
struct NamedProgram {
    std::string name;  ///< of the schedule
    SequencerProgram program;
};

/// The memory image of `program` for Verilog's $readmemh, with the sizes that a reader needs in
/// comments (docs/sequencer_program.md).
[[nodiscard]] std::string program_text(const NamedProgram& program);

/// The inverse. \throws InputError naming `where`, line and problem: a figure is missing, a word is
/// not hexadecimal, has another width, comes twice or not at all.
[[nodiscard]] NamedProgram parse_program(std::string_view text, const std::string& where);

}  // namespace stipple
