// Runs that take from the memo what an edit has left as it was: whatever that is, the bytes are those of a fresh run.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>
#include <vector>

#include "tests/modes/daemons.hpp"

namespace lightnet::memo_test {
namespace {

using test::counter;
using test::Folder;
using test::Launch;
using testing::HasSubstr;
using testing::Not;

constexpr std::array lightings{// layers, with gains
                               R"(direct = DirectLighting { samples = 1 }
bounce = PathTracing { samples = 1 }
lighting = Combine { direct, bounce }
)",
                               // what prepares, by rehearsals and without
                               R"(direct = DirectLighting { samples = 1 }
caustics = PhotonMap { photons = 2000, paths = "caustic" }
first = Combine { direct, caustics }
bounce = IrradianceCache { first, rays = 16 }
lighting = Combine { first, bounce }
)",
                               // what prepares for each pass, and noise that is seen
                               R"(direct = DirectLighting { samples = 1, error = 0.2 }
bounce = ProgressivePhotonMapping { paths = "indirect", photons = 500 }
lighting = Combine { direct, bounce }
)",
                               // photons, which take most of the rays
                               R"(direct = PhotonMap { photons = 20000, paths = "all" }
lighting = direct
)",
                               // lamps apart, of which one prepares
                               R"(direct = DirectLighting { samples = 1, lamps = "key" }
bounce = PathTracing { samples = 1, lamps = "key" }
soft = DirectLighting { samples = 1, lamps = "fill" }
glow = PathTracing { samples = 1, lamps = "fill" }
others = PhotonMap { photons = 2000, paths = "all", lamps = "rest" }
inner = Combine { glow, soft, weights = { 1, 0.5 } }
lighting = Combine { direct, bounce, inner, others }
)"};
constexpr int apart = 4;

/// All that somebody may edit, a number each, of which few are likely, so that earlier ones come back.
struct Edit {
    int lighting = 0;
    int eye = 0, lamp = 0, fill = 0, sky = 0, paint = 0, name = 0;                       // of the scene
    int gain = 0, exposure = 0, half = 0, samples = 0, seed = 0, noise = 0, unused = 0;  // of the graph

    std::vector<int*> numbers() {
        return {&eye, &lamp, &fill, &sky, &paint, &name, &gain, &exposure, &half, &samples, &seed, &noise, &unused};
    }
    std::string scene() const {
        return fmt::format(R"(LookAt {} 1 -4  0 .5 0  0 1 0
Camera "perspective" "float fov" 45
Film "rgb" "integer xresolution" 12 "integer yresolution" 12
WorldBegin
LightSource "infinite" "rgb L" [ .1 .2 {} ]
AttributeBegin
Attribute "light" "string name" "key"
LightSource "point" "rgb I" [ 9 8 7 ] "point3 from" [ {} 3 -2 ]
AttributeEnd
AttributeBegin
Attribute "light" "string name" "fill"
LightSource "point" "rgb I" [ 1 2 {} ] "point3 from" [ -3 3 -2 ]
AttributeEnd
MakeNamedMaterial "paint{}" "string type" "diffuse" "rgb reflectance" [ .{} .5 .4 ]
NamedMaterial "paint{}"
Shape "sphere" "float radius" 1
Material "conductor" "spectrum eta" "metal-Cu-eta" "spectrum k" "metal-Cu-k" "float roughness" 0
Shape "trianglemesh" "point3 P" [ -5 -1 -5  5 -1 -5  5 -1 5  -5 -1 5 ] "integer indices" [ 0 1 2 0 2 3 ]
)",
                           eye, 0.3 + sky, lamp, 3 + fill, name, 5 + paint, name);
    }
    std::string graph() const {
        const std::string error = noise ? "error = 0.1, " : "";
        return fmt::format(R"(scene = Scene {{ "room.pbrt", exposure = {}{} }}
{}other = AmbientOcclusion {{ samples = {} }}
image = RayTracer {{ lighting, {}scene = scene, samples = {},
    film = {{ 12, 12, half = {}, gains = {{ direct = {} }}, file = "picture.exr" }} }}
)",
                           exposure, lighting == apart ? R"(, groups = { key = "key", fill = "fill" })" : "",
                           lightings[static_cast<std::size_t>(lighting)], 1 + unused, error,
                           noise ? 48 + 16 * samples : 16 + 8 * samples, half ? "true" : "false", 1 - 0.5 * gain);
    }
};

class Memo : public testing::Test {
protected:
    Launch render(const Edit& edit, const std::vector<std::string>& more = {"--memo"}) {
        std::ofstream(there / "room.pbrt") << edit.scene();
        std::ofstream(there / "room.lua") << edit.graph();
        std::vector<std::string> words{"--threads", "1",        "--cache", there / "cache",          "--progress",
                                       "plain",     "--forget", "--seed",  std::to_string(edit.seed)};
        words.insert(words.end(), more.begin(), more.end());
        Launch launch = test::launch(there / "room.lua", there, words);
        EXPECT_EQ(launch.code, 0) << launch.said << edit.graph() << edit.scene();
        return launch;
    }
    Launch fresh(const Edit& edit) { return render(edit, {"--cache", "none"}); }
    // Rays of a run after another; the picture must be that of a fresh run.
    double rays_after(const Edit& before, const Edit& edit) {
        render(before);
        const Launch launch = render(edit);
        EXPECT_TRUE(launch.picture == fresh(edit).picture);
        said = launch.said;
        return counter(launch.report, "rays");
    }
    Folder there;
    std::string said;
};

TEST_F(Memo, AsksNoRayWhereNothingWasEdited) {
    EXPECT_EQ(rays_after({}, {}), 0);
    EXPECT_THAT(said, HasSubstr("memo: all of this picture is there; nothing is rendered"));
}

TEST_F(Memo, AsksNoRayForGainsExposureFilesAndNodesThatNobodyAsks) {
    for (int lighting : {0, 1}) {
        const Edit before{.lighting = lighting};
        for (const auto which : {&Edit::gain, &Edit::exposure, &Edit::half, &Edit::unused, &Edit::name}) {
            Edit after = before;
            after.*which = 1;
            if (lighting == 1 && which == &Edit::name) continue;  // photons ask for lists that have names
            EXPECT_EQ(rays_after(before, after), 0) << after.graph();
        }
    }
}

TEST_F(Memo, KnowsThatExposureCountsWhereNoiseIsSeen) {
    EXPECT_GT(rays_after({.lighting = 2}, {.lighting = 2, .exposure = 1}), 0);
    EXPECT_GT(rays_after({.noise = 1}, {.exposure = 1, .noise = 1}), 0);
}

TEST_F(Memo, AddsTheSamplesThatAreLacking) {
    const double all = counter(fresh({.samples = 2}).report, "rays");
    const double added = rays_after({}, {.samples = 2});
    EXPECT_NEAR(added, all / 2, all / 10) << "16 of 32 are there";
    EXPECT_THAT(said, HasSubstr("memo: 16 samples per pixel of 32 are there; the others are rendered"));
}

TEST_F(Memo, FindsFewerSamplesThatWereThereBefore) {
    render({});
    EXPECT_EQ(rays_after({.samples = 2}, {}), 0);
}

TEST_F(Memo, RendersAnewWhateverIsSeenOfTheScene) {
    const double all = counter(fresh({}).report, "rays");
    for (const auto which : {&Edit::eye, &Edit::lamp, &Edit::sky, &Edit::paint, &Edit::seed}) {
        Edit after;
        after.*which = 1;
        EXPECT_GT(rays_after({}, after), all / 2) << after.graph() << after.scene();
        EXPECT_THAT(said, HasSubstr("memo: nothing of this picture is there"));
    }
}

TEST_F(Memo, RendersNoLayerAnewWhoseLampsStay) {
    const double all = counter(fresh({.lighting = apart}).report, "rays");
    EXPECT_LT(rays_after({.lighting = apart}, {.lighting = apart, .fill = 1}), all / 2);
    EXPECT_THAT(said, HasSubstr("memo: layers that are there: direct, bounce, others; the others are rendered"));
    EXPECT_LT(rays_after({.lighting = apart}, {.lighting = apart, .lamp = 1}), all / 2);
    EXPECT_THAT(said, HasSubstr("memo: layers that are there: soft, glow, others; the others are rendered"));
    EXPECT_GT(rays_after({.lighting = apart}, {.lighting = apart, .eye = 1}), all / 10)
        << "the map of photons is there";
    EXPECT_THAT(said, HasSubstr("memo: nothing of this picture is there"));
}

TEST_F(Memo, TakesUpAPictureOfLayersThatWereThere) {
    render({.lighting = apart});
    render({.lighting = apart, .fill = 1});
    EXPECT_EQ(rays_after({.lighting = apart, .fill = 1}, {.lighting = apart, .fill = 1, .gain = 1}), 0);
    const double all = counter(fresh({.lighting = apart, .fill = 1, .samples = 2}).report, "rays");
    EXPECT_LT(rays_after({.lighting = apart, .fill = 1}, {.lighting = apart, .fill = 1, .samples = 2}), 0.6 * all);
    EXPECT_THAT(said, HasSubstr("memo: 16 samples per pixel of 32 are there"));
}

// Rays of a run whose results of preparing are kept, and no film.
TEST_F(Memo, ShootsNoPhotonAnewForAnotherCamera) {
    const auto rays = [&](const Edit& edit, const std::vector<std::string>& more) {
        const Launch launch = render(edit, more);
        EXPECT_TRUE(launch.picture == fresh(edit).picture);
        return counter(launch.report, "rays");
    };
    const Edit moved{.lighting = 3, .eye = 1};
    const double all = rays(moved, {"--cache", "none"});
    rays({.lighting = 3}, {});
    EXPECT_LT(rays(moved, {}), all / 2) << "the map of photons is there";
}

TEST_F(Memo, IsNotAskedForByItself) {
    render({}, {});
    EXPECT_THAT(render({}, {}).said, Not(HasSubstr("memo")));
    EXPECT_GT(rays_after({.seed = 9}, {}), 0) << "what was rendered without it is not kept";
}

TEST_F(Memo, KeepsNoMoreThanTheCacheMay) {
    const std::vector<std::string> small{"--memo", "--cache-size", "1K"};
    render({}, small);
    EXPECT_GT(counter(render({}, small).report, "rays"), 0);
}

TEST_F(Memo, RendersWhereAFilmIsDamaged) {
    render({});
    for (const auto& file : std::filesystem::recursive_directory_iterator(there / "cache"))
        if (file.is_regular_file() && file.file_size() > 2000)
            std::fstream(file.path(), std::ios::in | std::ios::out | std::ios::binary).seekp(1000) << "damaged";
    const Launch again = render({});
    EXPECT_GT(counter(again.report, "rays"), 0);
    EXPECT_TRUE(again.picture == fresh({}).picture);
}

TEST_F(Memo, TakesWhatHostsHaveRendered) {
    std::ofstream(there / "room.pbrt") << Edit().scene();
    std::ofstream(there / "room.lua") << Edit().graph();
    const Launch hosts = test::launch(there / "room.lua", there,
                                      {"--local-workers", "1", "--seed", "0", "--memo", "--cache", there / "cache"});
    ASSERT_EQ(hosts.code, 0) << hosts.said;
    const Launch launch = render({});
    EXPECT_EQ(counter(launch.report, "rays"), 0);
    EXPECT_TRUE(launch.picture == hosts.picture);
}

TEST_F(Memo, NeedsACache) {
    std::ofstream(there / "room.pbrt") << Edit().scene();
    std::ofstream(there / "room.lua") << Edit().graph();
    const Launch refused = test::launch(there / "room.lua", there, {"--memo", "--cache", "none"});
    EXPECT_EQ(refused.code, 2);
    EXPECT_THAT(refused.said, HasSubstr("--memo keeps films in the cache, and --cache is 'none'"));
}

#ifdef LIGHTNET_LARGE
constexpr int edits = 200, seeds = 20;
#else
constexpr int edits = 8, seeds = 2;
#endif

class RandomEdits : public Memo, public testing::WithParamInterface<int> {};

TEST_P(RandomEdits, GiveTheBytesOfFreshRuns) {
    int free_of_rays = 0;
    for (int seed = 0; seed < seeds; ++seed) {
        std::mt19937 random(static_cast<unsigned>(100 * GetParam() + seed));
        Edit edit{.lighting = GetParam()};
        for (int i = 0; i < edits; ++i) {
            auto numbers = edit.numbers();
            int& number = *numbers[random() % numbers.size()];
            number = number ? 0 : 1;
            const Launch launch = render(edit);
            free_of_rays += counter(launch.report, "rays") == 0;
            ASSERT_TRUE(launch.picture == fresh(edit).picture) << "seed " << seed << ", edit " << i << '\n'
                                                               << edit.graph() << edit.scene() << launch.said;
        }
    }
    RecordProperty("pictures without a ray", free_of_rays);
    EXPECT_GT(free_of_rays, 0) << "the memo was of no use";
}

INSTANTIATE_TEST_SUITE_P(Lightings, RandomEdits, testing::Values(0, 1, 2, apart));

}  // namespace
}  // namespace lightnet::memo_test
