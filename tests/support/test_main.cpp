#include <gtest/gtest.h>

#include "core/parallel.h"

int main(int argc, char** argv) {
#ifdef STIPPLE_ONE_THREAD
    const stipple::ThreadLimit one(1);
#endif
    testing::InitGoogleTest(&argc, argv);
    return RUN_ALL_TESTS();
}
