#include "core/named_value.h"

#include <gtest/gtest.h>

#include "tests/support/temporary_folder.h"

namespace stipple {
namespace {

enum class Metal { kIron, kGold, kLead };

constexpr auto kMetals =
    std::to_array<NamedValue<Metal>>({{"iron", Metal::kIron}, {"gold", Metal::kGold}});

TEST(NamedValueTest, NameAndValueAreEachOthersInverse) {
    for (const auto& [name, value] : kMetals) {
        EXPECT_EQ(name_in(kMetals, value), name);
        EXPECT_EQ(value_in(kMetals, name, "metal"), value);
    }
    EXPECT_EQ(name_in(kMetals, Metal::kLead), "");
}

TEST(NamedValueTest, AnUnknownNameIsRefusedWithThoseThatAreKnown) {
    for (const char* const name : {"lead", "", "Iron", "iron "})
        EXPECT_EQ(message_of<InputError>([&] { return value_in(kMetals, name, "metal"); }),
                  "metal: \"" + std::string(name) + "\" is none of iron, gold");
}

}  // namespace
}  // namespace stipple
