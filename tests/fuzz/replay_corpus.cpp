// Feeds each file of the folders given on the command line to a fuzz target, with any compiler.

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

int main(int argc, char** argv) {
    try {
        int inputs = 0;
        for (int i = 1; i < argc; ++i)
            for (const auto& entry : std::filesystem::directory_iterator(argv[i])) {
                std::printf("%s\n", entry.path().c_str());
                std::fflush(stdout);  // names the input that crashes
                std::ifstream file(entry.path(), std::ios::binary);
                const std::string bytes(std::istreambuf_iterator<char>(file), {});
                LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(bytes.data()),
                                       bytes.size());
                ++inputs;
            }
        return inputs > 0 ? 0 : 1;
    } catch (const std::exception& e) {
        std::fprintf(stderr, "%s\n", e.what());
        return 1;
    }
}
