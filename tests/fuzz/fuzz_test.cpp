// The fuzz targets with damaged inputs that are the same on every machine.
#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <random>

#include "tests/fuzz/numbers.hpp"
#include "tests/fuzz/targets.hpp"

namespace lightnet::fuzz {
namespace {

std::span<const std::byte> bytes_of(const std::string& text) { return std::as_bytes(std::span(text)); }

// Bytes flipped, cut out, repeated, brought in from another input or set to extremes.
class Vandal {
public:
    explicit Vandal(std::vector<std::string> seeds, std::uint64_t first = 1)
        : seeds_(std::move(seeds)), random_(first) {}

    std::string next() {
        std::string text = any_seed();
        for (auto blows = 1 + below(4); blows > 0 && !text.empty(); --blows) hit(text);
        return text;
    }

private:
    std::size_t below(std::size_t n) { return random_() % n; }
    const std::string& any_seed() { return seeds_[below(seeds_.size())]; }

    void hit(std::string& text) {
        const std::size_t at = below(text.size()), length = 1 + below(16);
        switch (below(8)) {
            case 6:
            case 7:
                make_extreme(text, at, below(extreme_numbers.size()));
                break;
            case 0:
                text[at] = static_cast<char>(text[at] ^ (1 << below(8)));
                break;
            case 1:
                text[at] = "\0\xff\x7f\x80\xdd"[below(5)];
                break;
            case 2:
                text.erase(at, length);
                break;
            case 3:
                text.insert(at, text.substr(below(text.size()), length));
                break;
            case 4:
                text.resize(at);
                break;
            default: {
                const auto& other = any_seed();
                text = text.substr(0, at) + other.substr(below(other.size()));
            }
        }
    }

    std::vector<std::string> seeds_;
    std::mt19937_64 random_;
};

class Reading : public testing::TestWithParam<Target> {};

TEST_P(Reading, TakesSoundInputs) {
    for (const auto& seed : GetParam().seeds()) EXPECT_NO_THROW(GetParam().read(bytes_of(seed)));
}

// What once ended the program, or went on for ever.
TEST_P(Reading, TakesWhatWasFoundBefore) {
    const auto folder = std::filesystem::path(LIGHTNET_SOURCE_DIR) / "tests/fuzz/found" / GetParam().name;
    if (!exists(folder)) return;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        std::ifstream file(entry.path(), std::ios::binary);
        const std::string text{std::istreambuf_iterator<char>(file), {}};
        EXPECT_NO_THROW(GetParam().read(bytes_of(text))) << entry.path();
    }
}

TEST_P(Reading, TakesInputsThatAreCutAnywhere) {
    for (const auto& seed : GetParam().seeds())
        for (std::size_t size = 0; size < seed.size(); size += GetParam().cost)
            EXPECT_NO_THROW(GetParam().read(bytes_of(seed.substr(0, size)))) << size;
}

// $LIGHTNET_FUZZ_SECONDS: each target goes on for so long, with inputs that $LIGHTNET_FUZZ_SEED begins.
void read_for_as_long_as_it_is_told(const Target& target) {
    const char *const seconds = std::getenv("LIGHTNET_FUZZ_SECONDS"), *const seed = std::getenv("LIGHTNET_FUZZ_SEED");
    if (!seconds) return;
    Vandal vandal(target.seeds(), seed ? std::stoull(seed) : 2);
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(std::stoi(seconds));
    std::size_t rounds = 0;
    for (; std::chrono::steady_clock::now() < end; ++rounds) {
        const auto text = vandal.next();
        std::ofstream("last_fuzz_input", std::ios::binary) << text;  // for who looks at a crash
        ASSERT_NO_THROW(target.read(bytes_of(text))) << "round " << rounds << ":\n" << text;
    }
    std::cout << rounds << " inputs\n";
}

TEST_P(Reading, TakesDamagedInputs) {
    Vandal vandal(GetParam().seeds());
    for (int round = 0; round < int(5000 / GetParam().cost); ++round) {
        const auto text = vandal.next();
        ASSERT_NO_THROW(GetParam().read(bytes_of(text))) << "round " << round << ":\n" << text;
    }
    read_for_as_long_as_it_is_told(GetParam());
}

INSTANTIATE_TEST_SUITE_P(Every, Reading, testing::ValuesIn(all_targets()),
                         [](const auto& tested) { return tested.param.name; });

}  // namespace
}  // namespace lightnet::fuzz
