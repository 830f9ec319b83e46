// fuzz_seeds TARGET FOLDER: writes the target's sound inputs into the folder, one file each.
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "tests/fuzz/targets.hpp"

int main(int argc, char** argv) {
    if (argc != 3) return 2;
    const std::filesystem::path folder = argv[2];
    std::filesystem::create_directories(folder);
    for (const auto& target : lightnet::fuzz::all_targets()) {
        if (target.name != argv[1]) continue;
        int number = 0;
        for (const auto& seed : target.seeds())
            std::ofstream(folder / ("seed-" + std::to_string(number++)), std::ios::binary) << seed;
        return 0;
    }
    std::fprintf(stderr, "there is no target '%s'\n", argv[1]);
    return 2;
}
