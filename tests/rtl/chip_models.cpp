#include <Vchip_group.h>
#include <Vchip_one.h>
#include <Vchip_paper.h>
#include <Vchip_small.h>
#include <chip_sizes.h>

#include "tests/rtl/verilated_run.h"

namespace stipple {

std::span<const ChipModel> chip_models() {
    static constexpr ChipModel kModels[] = {
        {"paper", paper_size, run_verilated<Vchip_paper>},
        {"small", small_size, run_verilated<Vchip_small>},
        {"group", group_size, run_verilated<Vchip_group>},
        {"one", one_size, run_verilated<Vchip_one>},
    };
    return kModels;
}

}  // namespace stipple
