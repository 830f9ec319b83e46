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

// ---- light that media scatter ----

double mean_of(const std::vector<Rgb>& pixels) {
    double sum = 0;
    for (const Rgb& pixel : pixels) sum += (double(pixel.r) + pixel.g + pixel.b) / 3;
    return sum / double(pixels.size());
}

// A point light in fog before a grey wall: the eye at (0, 0, 3), the light at (0, 1, 0), the wall at z = -3.
class FoggyLayersRun : public PathLayersRun {
protected:
    static constexpr double extinction = 0.3, albedo = 0.6, radiance = 5, grey = 0.5, wall = 6;

    FoggyLayersRun() {
        folder_.write("fog.pbrt",
                      "LookAt 0 0 3  0 0 0  0 1 0\nCamera \"perspective\" \"float fov\" 0.02\nWorldBegin\n"
                      "LightSource \"point\" \"point3 from\" [ 0 1 0 ] \"rgb I\" [ 5 5 5 ]\n"
                      "Material \"diffuse\" \"rgb reflectance\" [ 0.5 0.5 0.5 ]\n"
                      "Shape \"trianglemesh\" \"integer indices\" [ 0 1 2 0 2 3 ]\n"
                      "\"point3 P\" [ -9 -9 -3  9 -9 -3  9 9 -3  -9 9 -3 ]\n");
    }
    Picture foggy(const std::string& operators, const std::string& layers,
                  const std::vector<std::string>& more = {}) const {
        std::vector<std::string> words{"--size", "16x16", "--samples", "64"};
        words.insert(words.end(), more.begin(), more.end());
        return rendered(folder_.write("fog.lua",
                                      "scene = Scene { \"fog.pbrt\", fog = { density = 0.3, albedo = { 0.6, "
                                      "0.6, 0.6 }, g = 0 } }\n" +
                                          operators + "image = RayTracer { light, scene = scene, film = { 8, 8 }" +
                                          layers + " }\n"),
                        words);
    }
    // ∫ σ_s / 4π × I / d² × exp(-σ_t (t + d)) dt from the eye to the wall.
    static double scattered_once() {
        double sum = 0;
        constexpr int steps = 100000;
        for (int i = 0; i < steps; ++i) {
            const double t = (i + 0.5) * wall / steps, d = std::sqrt(1 + (3 - t) * (3 - t));
            sum += extinction * albedo / (4 * pi) * radiance / (d * d) * std::exp(-extinction * (t + d)) * wall / steps;
        }
        return sum;
    }
    static double off_the_wall() {
        const double d = std::sqrt(1 + 3.0 * 3);
        return grey / pi * radiance / (d * d) * (3 / d) * std::exp(-extinction * (wall + d));
    }
    static constexpr double pi = 3.14159265358979323846;
};

const std::string told_apart =
    "direct = DirectLighting {}\nlit = Select { direct, where = \"surfaces\" }\n"
    "around = DirectLighting {}\nlit_fog = Select { around, where = \"media\" }\n"
    "bounce = PathTracing {}\nlight = Combine { lit, lit_fog, bounce }\n";
const std::string by_letters = ", layers = { once = \"CS*VL\", first = \"CS*DL\", more = \"CS*[DV].+L\" }";

TEST_F(FoggyLayersRun, HoldWhatFogScattersOnceBesideWhatTheWallDoes) {
    const auto picture = foggy(told_apart, by_letters);
    ASSERT_THAT(names_of(picture), ElementsAre("emission", "first", "once", "more"));
    EXPECT_NEAR(mean_of(pixels_of(picture, "once")), scattered_once(), 0.03 * scattered_once());
    EXPECT_NEAR(mean_of(pixels_of(picture, "first")), off_the_wall(), 0.03 * off_the_wall());
    for (std::size_t i = 0; i < picture.beauty.size(); ++i) {
        Rgb sum{};
        for (const auto& layer : picture.layers) sum += layer.pixels[i];
        EXPECT_TRUE(sum == picture.beauty[i]) << "at pixel " << i;
    }
}

TEST_F(FoggyLayersRun, AddUpToTheLightThatNobodyTellsApart) {
    const std::string direct = "direct = DirectLighting {}\n";
    const auto whole = foggy(direct + "light = Combine { direct }\n", "");
    const auto in_fog =
        foggy(direct + "light = Select { direct, where = \"media\" }\n", ", layers = { once = \"CS*VL\" }");
    const auto first = foggy(direct + "light = Select { direct, where = \"media\", except = true }\n",
                             ", layers = { first = \"CS*DL\" }");
    for (std::size_t i = 0; i < whole.beauty.size(); ++i)
        EXPECT_NEAR(pixels_of(in_fog, "once")[i].g + pixels_of(first, "first")[i].g, whole.beauty[i].g,
                    1e-5f * (1 + whole.beauty[i].g))
            << "at pixel " << i;
}

TEST_F(FoggyLayersRun, HaveTheBytesOfOneThreadOnTwo) {
    foggy(told_apart, by_letters, {"--threads", "1"});
    const auto serial = bytes_of(folder_ / "picture.exr");
    foggy(told_apart, by_letters, {"--threads", "2", "--tile", "8", "--forget"});
    EXPECT_TRUE(bytes_of(folder_ / "picture.exr") == serial);
}

}  // namespace
}  // namespace lightnet::test
