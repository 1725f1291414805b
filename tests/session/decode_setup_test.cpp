#include "session/decode_setup.h"

#include <gtest/gtest.h>

#include <vector>

#include "core/error.h"
#include "decoder/decode_options.h"
#include "tests/study/explore/dictionary_bytes.h"
#include "tests/support/temporary_folder.h"

namespace stipple {
namespace {

TEST(DecodeSetupTest, ReadsTheFileThatTheOptionsName) {
    const TemporaryFolder folder;
    write_text(folder / "d.npy", dictionary_bytes(4));
    DecodeOptions options{.method = DecodeMethod::kHitomi2011};
    read_option_file(options);
    EXPECT_EQ(options.hitomi2011.dictionary.atoms, 0);
    options.hitomi2011.dictionary_file = (folder / "d.npy").string();
    read_option_file(options);
    const PatchDictionary& dictionary = options.hitomi2011.dictionary;
    EXPECT_EQ(dictionary.shape, (AtomShape{.slots = 2, .side_px = 1}));
    EXPECT_EQ(dictionary.values, (std::vector<float>{0.6F, 0.8F}));
}

TEST(DecodeSetupTest, AMissingFileSaysHowToMakeIt) {
    DecodeOptions options{.method = DecodeMethod::kHitomi2011};
    options.hitomi2011.dictionary_file = "nosuch.npy";
    expect_parts(message_of<InputError>([&] { read_option_file(options); }),
                 {"nosuch.npy: ", "no such dictionary", "stipple dictionary"});
}

}  // namespace
}  // namespace stipple
