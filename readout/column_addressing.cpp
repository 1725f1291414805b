#include "readout/column_addressing.h"

#include <array>
#include <string_view>

#include "core/config.h"
#include "core/named_value.h"

namespace stipple {
namespace {

constexpr auto kKinds = std::to_array<NamedValue<ColumnAddressing::Kind>>(
    {{"skip_channel", ColumnAddressing::Kind::kSkipChannel},
     {"group", ColumnAddressing::Kind::kGroup}});
constexpr KeyRange kSide{1, ColumnAddressing::kMaxSide};

}  // namespace

void read_addressing(const KeyReader& read, ColumnAddressing& addressing) {
    read({"addressing", {}, "", "column by column, or whole groups", kNamesOf<kKinds>},
         addressing.kind);
    read({"channels", {1, ColumnAddressing::kMaxChannels}, "", "outputs that work in parallel"},
         addressing.channels);
    read({"group_cols", kSide, "pixels", "columns of a group"}, addressing.group_cols);
    read({"group_rows", kSide, "pixels", "rows of a group"}, addressing.group_rows);
}

}  // namespace stipple
