// A picture whose layers are named by light path expressions is the one without, put together otherwise.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/base/error.hpp"
#include "core/film/exr.hpp"
#include "tests/modes/daemons.hpp"

namespace lightnet::test {
namespace {

using testing::ElementsAre;

std::vector<std::string> names_of(const Picture& picture) {
    std::vector<std::string> names;
    for (const auto& layer : picture.layers) names.push_back(layer.name);
    return names;
}

const std::vector<Rgb>& pixels_of(const Picture& picture, const std::string& name) {
    for (const auto& layer : picture.layers)
        if (layer.name == name) return layer.pixels;
    throw Error("no layer " + name);
}

// The graph as it is, and without its expressions.
class PathLayersRun : public ::testing::Test {
protected:
    PathLayersRun() {
        folder_.write("studio.pbrt", bytes_of(graph_file("studio.pbrt")));
        auto text = bytes_of(graph_file("expressions.lua"));
        const auto from = text.find("layers = {"), to = text.find("},", from) + 2;
        without_ = folder_.write("without.lua", text.erase(from, to - from));
    }
    Picture rendered(const std::string& graph, const std::vector<std::string>& more = {}) const {
        const auto file = folder_ / "picture.exr";
        std::vector<std::string> words{"--size", "64x48", "--samples", "8"};
        words.insert(words.end(), more.begin(), more.end());
        Process run(launch_words(graph, file, words));
        const auto made = finish(run, file);
        EXPECT_EQ(made.code, 0) << made.said;
        return read_exr(file);
    }
    const Folder folder_;
    std::string without_;
};

TEST_F(PathLayersRun, HoldsTheLightOfTheOperatorsThatAnExpressionTakes) {
    const auto named = rendered(graph_file("expressions.lua")), plain = rendered(without_);
    EXPECT_THAT(names_of(named), ElementsAre("softbox", "emission.rest", "lit", "indirect"));
    EXPECT_THAT(names_of(plain),
                ElementsAre("emission.key", "emission.rest", "direct.key", "direct.rest", "bounce.key", "bounce.rest"));
    EXPECT_TRUE(pixels_of(named, "lit") == pixels_of(plain, "direct.rest"));
    EXPECT_TRUE(pixels_of(named, "indirect") == pixels_of(plain, "bounce.rest"));
    EXPECT_TRUE(pixels_of(named, "emission.rest") == pixels_of(plain, "emission.rest"));
    double sum = 0;
    for (std::size_t i = 0; i < plain.beauty.size(); ++i) {
        const Rgb whole =
            pixels_of(plain, "emission.key")[i] + pixels_of(plain, "direct.key")[i] + pixels_of(plain, "bounce.key")[i];
        const Rgb found = pixels_of(named, "softbox")[i];
        sum += found.g;
        for (const auto& [a, b] : {std::pair(found.r, whole.r), {found.g, whole.g}, {found.b, whole.b}})
            ASSERT_NEAR(a, b, 1e-5f * (1 + std::fabs(b))) << "at pixel " << i;
    }
    EXPECT_GT(sum, 1) << "the key light lights something";
}

TEST_F(PathLayersRun, IsMixedAnewLikeAnyOther) {
    rendered(graph_file("expressions.lua"));
    const auto mixed = folder_ / "mixed.exr";
    Process remix({program("lightnet"), "remix", folder_ / "picture.exr", "softbox=0.5", "lit=1.5,1,0", "-o", mixed});
    ASSERT_EQ(remix.wait(), 0) << remix.output();
    rendered(graph_file("expressions.lua"), {"--forget", "--gain", "softbox=0.5", "--gain", "lit=1.5,1,0"});
    EXPECT_TRUE(bytes_of(mixed) == bytes_of(folder_ / "picture.exr"));
}

}  // namespace
}  // namespace lightnet::test
