#include "study/explore/results.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "study/explore/exploration.h"
#include "tests/support/temporary_folder.h"

namespace stipple {
namespace {

class ResultsTableTest : public testing::Test {
  protected:
    /// Points 0 and 1; the second has no figures.
    Exploration explored() {
        write_text(folder_ / "space.toml",
                   "[axes]\nsensor = 'paper'\nmethod = ['naive', '=no, \"such\"']\n"
                   "[clip]\nframes = 12\nrows = 8\ncols = 8\n");
        Exploration exploration(folder_ / "space.toml", folder_ / "results", {},
                                [] { return true; });
        exploration.next_rung();
        static_cast<void>(exploration.begin(0));
        exploration.put(0, {{.limited_by = "slot", .psnr_db = 31.5},
                            {.rows = 1, .cols = 1, .channels = 1, .bytes = {7}}});
        static_cast<void>(exploration.begin(1));
        return exploration;
    }

    const TemporaryFolder folder_;
};

TEST_F(ResultsTableTest, ARowHasValuesFiguresAndTheProblem) {
    const Exploration exploration = explored();
    const auto value = [&](std::uint64_t number, const std::string& column) {
        for (const TableCell& cell : table_row(exploration, number))
            if (cell.column == column) return cell.value;
        ADD_FAILURE() << "no column " << column;
        return TableValue();
    };
    EXPECT_EQ(value(0, "method"), TableValue("naive"));
    EXPECT_EQ(value(0, "psnr_db"), TableValue(31.5));
    EXPECT_EQ(value(0, "energy_uj_per_slot"), TableValue());
    EXPECT_EQ(value(0, "limited_by"), TableValue("slot"));
    EXPECT_EQ(value(0, "slots"), TableValue(12));
    EXPECT_EQ(value(0, "problem"), TableValue(""));
    EXPECT_EQ(value(1, "psnr_db"), TableValue());
    EXPECT_EQ(value(1, "rung"), TableValue());
    EXPECT_NE(value(1, "problem"), TableValue(""));
}

TEST_F(ResultsTableTest, TextsOfTheCsvAreQuotedWhereTheyMustBe) {
    const std::string text = csv_table(explored());
    expect_parts(
        text, {"footage,sensor,schedule,method,seed,slots_per_second,",
               ",limited_by,compared_slots,rung,slots,problem\npan,paper,random,naive,1,", ",31.5,",
               ",slot,,1,12,\n", "\npan,paper,random,\"'=no, \"\"such\"\"\",1,,"});
}

}  // namespace
}  // namespace stipple
