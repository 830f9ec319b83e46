// Random graphs of kinds that prepare themselves: the same bytes in every mode, over the network as well.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <random>
#include <string>
#include <vector>

#include "tests/modes/daemons.hpp"

namespace lightnet::random_preparing_test {
namespace {

using namespace test;

/// Writes graphs in Lua. Each node asks some of those before it; what nobody asks is the light of the picture.
class Author {
public:
    explicit Author(unsigned seed) : random_(seed) {}

    std::string graph() {
        text_ = "scene = Scene { '" + graph_file("glass_ball.pbrt") + "' }\n";
        lights_ = maps_ = {};
        unasked_ = {};
        add("DirectLighting {}");
        for (std::size_t count = 2 + below(4); count > 0; --count) add_any();
        std::string all;
        for (const auto& name : unasked_) all += name + ", ";
        return text_ + "lighting = Combine { " + all + "}\n" +
               "image = RayTracer { lighting, scene = scene, samples = 32, film = { 16, 12 } }\n";
    }

private:
    std::size_t below(std::size_t end) { return random_() % end; }
    std::string one_of(const std::vector<std::string>& names) { return names[below(names.size())]; }

    // Of nodes that give the same light in each pass.
    std::string input() {
        const auto name = one_of(lights_);
        std::erase(unasked_, name);
        return name;
    }
    std::string add(const std::string& kind, bool may_be_asked = true) {
        const auto name = fmt::format("n{}", ++count_);
        text_ += name + " = " + kind + "\n";
        unasked_.push_back(name);
        if (may_be_asked) lights_.push_back(name);
        return name;
    }

    void add_any() {
        const std::string paths = one_of({"caustic", "diffuse", "indirect", "all"});
        switch (below(7)) {
            case 0:
                maps_.push_back(add(
                    fmt::format("PhotonMap {{ paths = '{}', photons = {}, gather = 20 }}", paths, 200 + below(2000))));
                return;
            case 1:
                add(fmt::format("ProgressivePhotonMapping {{ paths = '{}', photons = 500 }}", paths), false);
                return;
            case 2:
                add(fmt::format("IrradianceCache {{ {}, rays = 16, error = 0.5 }}", input()));
                return;
            case 3:
                add(fmt::format("FinalGather {{ {} }}", input()));
                return;
            case 4:
                text_ += fmt::format("guide{} = Guide {{ paths = 500, when = 'always' }}\n", count_ + 1);
                add(fmt::format("PathTracing {{ guide = guide{} }}", count_ + 1));
                return;
            case 5:
                if (!maps_.empty()) add(fmt::format("PhotonIrradiance {{ of = {} }}", one_of(maps_)));
                return;
            default:
                add(fmt::format("Combine {{ {}, {} }}", input(), input()));
        }
    }

    std::mt19937 random_;
    std::size_t count_ = 0;
    std::string text_;
    std::vector<std::string> lights_, maps_, unasked_;
};

class RandomPreparing : public ::testing::TestWithParam<unsigned> {};

TEST_P(RandomPreparing, HasTheSameBytesInEveryMode) {
    Author author(GetParam());
    const Folder folder;
    for (int i = 0; i < 4; ++i) {
        const auto text = author.graph();
        const auto graph = folder.write("graph.lua", text);
        const std::vector<std::string> usual{"--progress", "none", "--cache", "none", "--wait", "30"};
        const auto run = [&](const std::vector<std::string>& more) {
            auto words = usual;
            words.insert(words.end(), more.begin(), more.end());
            return launch(graph, folder, words);
        };
        const auto serial = run({"--threads", "1"});
        ASSERT_EQ(serial.code, 0) << serial.said << text;
        for (const auto& mode : {std::vector<std::string>{"--threads", "3", "--tile", "8"}, {"--local-workers", "2"}}) {
            const auto other = run(mode);
            EXPECT_EQ(other.code, 0) << mode.front() << other.said << text;
            EXPECT_TRUE(other.picture == serial.picture) << mode.front() << "\n" << text;
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Seeds, RandomPreparing, testing::Range(1u, 5u));

}  // namespace
}  // namespace lightnet::random_preparing_test
