// Maps of the sky: where their pixels lie, and how directions are drawn from them.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <numbers>

#include "core/base/math/prefix_cdf.hpp"
#include "core/base/math/samples.hpp"
#include "core/base/math/sampling.hpp"
#include "core/base/math/sky_layout.hpp"
#include "core/scene/bare_lights/environment.hpp"
#include "core/scene/bare_lights/environment_map.hpp"
#include "core/scene/direct_light.hpp"
#include "core/scene/lamps/lights.hpp"
#include "core/scene/scene.hpp"
#include "tests/support/both_ways.hpp"
#include "tests/support/small_scenes.hpp"

namespace lightnet::environment_test {
namespace {

using namespace test;
using Layout = EnvironmentData::Layout;

// Noise between 0 and 1, a few black pixels, and a small sun.
std::shared_ptr<const Image> picture(std::uint32_t width, std::uint32_t height, float sun) {
    std::vector<Rgb> pixels;
    for (std::uint32_t i = 0; i < width * height; ++i) {
        Samples samples(11, i);
        const float c = i % 5 == 0 ? 0 : samples.next();
        pixels.push_back({c, samples.next(), 0.3f * c});
    }
    pixels[(height / 3) * width + width / 4] = Rgb{1, 0.95f, 0.85f} * sun;
    return std::make_shared<const Image>(width, height, pixels);
}

Matrix turned() {  // 120° around the diagonal, then a mirror: all axes change places
    Matrix m;
    m.m = {{{0, 0, -1, 0}, {1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 0, 1}}};
    return m;
}

EnvironmentData map_of(Layout layout, float sun = 300) {
    EnvironmentData data;
    data.radiance = {1, 2, 0.5f};
    data.image = layout == Layout::equal_area ? picture(24, 24, sun) : picture(48, 24, sun);
    data.layout = layout;
    data.to_world = turned();
    return data;
}

// ∫ f dω over all directions, by midpoints in cosine and angle.
double over_the_sphere(int n, const std::function<double(Vec3)>& f) {
    double sum = 0;
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < 2 * n; ++j) {
            const double z = -1 + (i + 0.5) * 2 / n, phi = std::numbers::pi * (j + 0.5) / n, s = std::sqrt(1 - z * z);
            sum += f({float(s * std::cos(phi)), float(s * std::sin(phi)), float(z)});
        }
    return sum * 4 * std::numbers::pi / (2.0 * n * n);
}

TEST(SkyLayout, OfLatitudeAndLongitudeHasTheTopAboveAndTheMiddleAhead) {
    const auto near = [](Vec2 a, Vec2 b) { return std::fabs(a.x - b.x) + std::fabs(a.y - b.y) < 1e-6f; };
    EXPECT_TRUE(near(to_latitude_longitude({0, 0, -1}), {0.5f, 0.5f}));
    EXPECT_TRUE(near(to_latitude_longitude({1, 0, 0}), {0.75f, 0.5f}));
    EXPECT_NEAR(to_latitude_longitude({0, 1, 0}).y, 0, 1e-6f);
    EXPECT_NEAR(to_latitude_longitude({0, -1, 0}).y, 1, 1e-6f);
}

// Values of pbrt-v4's EqualAreaSphereToSquare.
TEST(SkyLayout, OfEqualAreasHasThePoleInTheMiddle) {
    const auto near = [](Vec2 a, Vec2 b) { return std::fabs(a.x - b.x) + std::fabs(a.y - b.y) < 1e-6f; };
    EXPECT_TRUE(near(to_equal_area({0, 0, 1}), {0.5f, 0.5f}));
    EXPECT_TRUE(near(to_equal_area({1, 0, 0}), {1, 0.5f}));
    EXPECT_TRUE(near(to_equal_area({0, 1, 0}), {0.5f, 1}));
    EXPECT_TRUE(near(to_equal_area({-1, 0, 0}), {0, 0.5f}));
    const Vec2 corner = to_equal_area({0, 0, -1});
    EXPECT_NEAR(std::fabs(corner.x - 0.5f), 0.5f, 1e-6f);
    EXPECT_NEAR(std::fabs(corner.y - 0.5f), 0.5f, 1e-6f);
}

TEST(SkyLayout, LeadsBackToWhereItCameFrom) {
    for (std::uint32_t i = 0; i < 20000; ++i) {
        const Vec3 d = sphere(Samples(2, i).next_2d());
        ASSERT_NEAR(length(from_equal_area(to_equal_area(d)) - d), 0, 2e-6f);
        ASSERT_NEAR(length(from_latitude_longitude(to_latitude_longitude(d)) - d), 0, 2e-6f);
    }
}

TEST(Environment, ShowsItsPixelsWhereTheyBelong) {
    std::vector<Rgb> pixels(8 * 4);
    for (std::uint32_t i = 0; i < pixels.size(); ++i) pixels[i] = {float(i), 1, 0};
    EnvironmentData data;
    data.image = std::make_shared<const Image>(8, 4, pixels);
    const Environment upright(data);
    for (std::uint32_t y = 0; y < 4; ++y)
        for (std::uint32_t x = 0; x < 8; ++x)
            EXPECT_NEAR(upright.radiance(from_latitude_longitude({(float(x) + 0.5f) / 8, (float(y) + 0.5f) / 4})).r,
                        float(8 * y + x), 1e-4f);
    data.to_world = turned();
    const Vec3 ahead = transform_direction(turned(), {0, 0, -1});
    EXPECT_NEAR(Environment(data).radiance(ahead).r, upright.radiance({0, 0, -1}).r, 1e-4f);
}

TEST(EnvironmentMap, IsSharedByLightsOfAnyTurnAndScale) {
    std::vector<Rgb> pixels(8 * 4, Rgb{1, 2, 3});
    pixels[13] = {40, 50, 60};
    EnvironmentData data;
    data.image = std::make_shared<const Image>(8, 4, pixels);
    const auto map = environment_map(data.image, data.layout);
    const Environment plain(data);
    data.radiance = {2, 2, 2};
    const Environment bright(data);
    data.to_world = turned();
    const Environment aside(data);
    EXPECT_EQ(environment_map(data.image, data.layout), map);
    EXPECT_NE(environment_map(data.image, EnvironmentData::Layout::equal_area), map);
    EXPECT_GE(map.use_count(), 4);  // nobody has one of his own
    for (std::uint32_t i = 0; i < 100; ++i) {
        const Vec2 u = Samples(11, i).next_2d();
        const SkyRadiance one = plain.sample(u), two = bright.sample(u), there = aside.sample(u);
        EXPECT_EQ(one.pdf, two.pdf);
        EXPECT_EQ(2 * one.radiance, two.radiance);
        EXPECT_NEAR(length(transform_direction(turned(), one.direction) - there.direction), 0, 1e-5f);
    }
    EXPECT_EQ(2 * plain.total(), bright.total());
}

TEST(Shares, AreFoundByMarksAsWithoutThem) {
    for (const std::size_t count : {1u, 2u, 9u, 100u, 1000u}) {
        std::vector<double> parts;
        for (std::size_t i = 0; i < count; ++i) parts.push_back(i % 7 == 3 ? 0 : Samples(6, std::uint32_t(i)).next());
        if (count == 1000) parts[500] = 1e5;
        std::vector<float> ends;
        prefix_cdf(parts, ends);
        for (const std::size_t pieces : {1u, 4u, 64u}) {
            std::vector<std::uint32_t> starts(pieces + 1);
            mark(ends, starts);
            const auto expect_same = [&](float u) {
                float plain = u, marked = u;
                ASSERT_EQ(pick(ends, starts, marked), pick(ends, plain));
                ASSERT_EQ(marked, plain);
            };
            for (std::uint32_t i = 0; i < 2000; ++i) expect_same(Samples(7, i).next());
            for (const float end : ends)
                for (const float u : {std::nextafter(end, 0.0f), end})
                    if (u < 1) expect_same(u);
            for (const float u : {0.0f, 0.25f, 0.5f, 0x1.fffffep-1f}) expect_same(u);
        }
    }
}

class Maps : public testing::TestWithParam<Layout> {};

TEST_P(Maps, AreSmooth) {  // across pixels, and across the picture's borders
    const Environment sky(map_of(GetParam()));
    for (std::uint32_t i = 0; i < 20000; ++i) {
        Samples samples(3, i);
        const Vec3 a = sphere(samples.next_2d()), b = normalize(a + sphere(samples.next_2d()) * 1e-5f);
        if (std::fabs(dot(a, transform_direction(turned(), {0, 1, 0}))) > 0.999f) continue;  // the poles
        const float there = sky.radiance(a).g;
        ASSERT_NEAR(there, sky.radiance(b).g, 0.1f);
    }
}

TEST_P(Maps, HaveADensityThatIntegratesToOne) {
    const Environment sky(map_of(GetParam(), 2));
    EXPECT_NEAR(over_the_sphere(1500, [&](Vec3 d) { return sky.pdf(d); }), 1, 2e-3);
}

TEST_P(Maps, SampleWhatTheirDensitySays) {
    const Environment sky(map_of(GetParam(), 2));
    constexpr int rows = 12, columns = 24, n = 200000;
    const auto bin = [](Vec3 d) {
        const int row = std::min(rows - 1, int((d.z + 1) / 2 * rows));
        const double turn = std::atan2(d.y, d.x) / (2 * std::numbers::pi) + 0.5;
        return row * columns + std::min(columns - 1, int(turn * columns));
    };
    std::vector<double> expected(rows * columns), found(rows * columns);
    over_the_sphere(768, [&](Vec3 d) {
        expected[bin(d)] += sky.pdf(d);
        return 0;
    });
    double all = 0;
    for (const double e : expected) all += e;
    int same_density = 0;
    for (std::uint32_t i = 0; i < n; ++i) {
        const auto [d, radiance, pdf] =
            sky.sample({float(mix(2 * i) >> 40) * 0x1p-24f, float(mix(2 * i + 1) >> 40) * 0x1p-24f});
        ASSERT_NEAR(length(d), 1, 1e-5f);
        ASSERT_GT(pdf, 0);
        ASSERT_NEAR(radiance.g, sky.radiance(d).g, 1e-2f);
        same_density += pdf == sky.pdf(d);
        found[bin(d)] += 1;
    }
    EXPECT_GT(same_density, 0.9999 * n);  // rounding may put a direction across the border of its cell
    double chi2 = 0, freedom = -1, rest_expected = 0, rest_found = 0;
    for (std::size_t i = 0; i < found.size(); ++i) {
        const double e = expected[i] / all * n;
        if (e < 5) {  // dark parts
            rest_expected += e;
            rest_found += found[i];
            continue;
        }
        chi2 += (found[i] - e) * (found[i] - e) / e;
        freedom += 1;
    }
    EXPECT_NEAR(rest_found, rest_expected, 4 * std::sqrt(rest_expected + 1));
    EXPECT_GT(freedom, rows * columns / 4);
    EXPECT_LT(chi2, freedom + 4 * std::sqrt(2 * freedom));  // mean and variance of chi-square are this and twice this
}

// What is darker is not sampled at all, and the rest by how much brighter it is.
TEST(Environment, SamplesWhatIsBrighterThanItsMean) {
    constexpr std::uint32_t width = 64, height = 32;
    std::vector<Rgb> pixels;
    for (std::uint32_t i = 0; i < width * height; ++i) pixels.push_back(Rgb{1, 1, 1} * (i % width < width / 2 ? 1 : 3));
    EnvironmentData data;
    data.image = std::make_shared<const Image>(width, height, pixels);
    const Environment sky(data);
    const Vec3 dark = from_latitude_longitude({0.25f, 0.5f}), bright = from_latitude_longitude({0.75f, 0.5f});
    EXPECT_EQ(sky.pdf(dark), 0);
    EXPECT_NEAR(sky.pdf(bright) * 2 * pi, 1, 0.03f);  // half of all around; next to the edges it falls off
    EXPECT_EQ(sky.radiance(dark).r, 1);
}

// Those who have no other way to find light, as photons, are sent to all of it.
TEST_P(Maps, AreReachedAsAWhole) {
    const Environment sky(map_of(GetParam()));
    constexpr std::uint32_t n = 1 << 16;
    double light = 0, height = 0;
    for (std::uint32_t i = 0; i < n; ++i) {
        const auto [d, radiance, pdf] = sky.sample_all(Samples(9, i).next_2d());
        ASSERT_GT(pdf, 0);
        light += radiance.g / pdf / n;
        height += radiance.g * d.z / pdf / n;
    }
    const double expected = over_the_sphere(700, [&](Vec3 d) { return sky.radiance(d).g; });
    EXPECT_NEAR(light / expected, 1, 0.01);
    EXPECT_NEAR(height / expected, over_the_sphere(700, [&](Vec3 d) { return sky.radiance(d).g * d.z; }) / expected,
                0.01);
}

void expect_equal(const SkyRadiance& one, const SkyRadiance& other) {
    EXPECT_EQ(one.direction, other.direction);
    EXPECT_EQ(one.radiance, other.radiance);
    EXPECT_EQ(one.pdf, other.pdf);
}

TEST_P(Maps, GiveManyAtOnceWhatTheyGiveOneByOne) {
    const Environment sky(map_of(GetParam()));
    std::vector<Vec2> u{{0, 0}, {0x1.fffffep-1f, 0x1.fffffep-1f}};
    for (std::uint32_t i = 0; i < 1022; ++i) u.push_back(Samples(5, i).next_2d());
    for (std::size_t i = 0; i < u.size(); i += lanes) {
        const std::size_t count = i == 0 ? 3 : lanes;  // few as well
        std::array<SkyRadiance, lanes> sampled, seen;
        std::array<Vec3, lanes> directions;
        sky.sample(std::span(u).subspan(i, count), sampled);
        for (std::size_t k = 0; k < count; ++k) directions[k] = sphere(u[i + k]);
        sky.look(std::span(directions).first(count), seen);
        for (std::size_t k = 0; k < count; ++k) {
            expect_equal(sampled[k], sky.sample(u[i + k]));
            expect_equal(seen[k], sky.look(directions[k]));
            ASSERT_FALSE(HasFailure()) << i + k;
        }
    }
}

// Of lamps, alone, with a distant light and a sun, and with a map as well.
TEST(ManyLights, AreFoundAtOnceAsOneByOne) {
    for (const auto& [far, map] : {std::pair(false, false), std::pair(true, false), std::pair(true, true)}) {
        SceneData data;
        const auto black = diffuse(data, 0);
        add(data, quad({-1, -1, 2}, {0, 2, 0}, {2, 0, 0}), black).emission = AreaEmission{{1, 2, 3}, false};
        add(data, ball({3, 0, 1}, 0.5f), black).emission = AreaEmission{{4, 1, 1}, false};
        add(data, ball({0.5f, 0, 0}, 1), black).emission = AreaEmission{{1, 1, 4}, true};  // around some of the points
        add(data, quad({-2, 1, 1}, {0, 1, 0}, {1, 0, 0.5f}), black).emission = AreaEmission{{2, 2, 1}, true};
        data.shapes.push_back(data.shapes.back());
        std::get<Mesh>(data.shapes.back().geometry).triangles.pop_back();
        if (far) {
            data.lights.push_back(DirectionalLight{.direction = {0, 0, -1}, .irradiance = {1, 1, 1}});
            data.lights.push_back(
                DirectionalLight{.direction = {0, 1, 0}, .irradiance = {1, 1, 1}, .half_angle = 0.1f});
        }
        if (map) data.environments.push_back(map_of(Layout::equal_area));
        const Scene scene(data);
        for (std::uint32_t first = 0; first < 512; first += lanes) {
            std::vector<LitPoint> from;
            std::vector<float> choices;
            std::vector<Vec2> u;
            for (std::uint32_t i = first; i < first + lanes; ++i) {
                Samples samples(3, i);
                choices.push_back(samples.next());
                u.push_back(samples.next_2d());
                from.emplace_back(sphere(samples.next_2d()), sphere(samples.next_2d()));
            }
            LightSamples found;
            scene.lights().sample(from, choices, u, found);
            for (std::size_t i = 0; i < lanes; ++i) {
                const auto one = scene.lights().sample(from[i], choices[i], u[i]);
                ASSERT_EQ(found.found[i] != 0, one.has_value());
                if (one) {
                    ASSERT_EQ(found[i], *one);
                }
            }
        }
    }
}

TEST_P(Maps, CountAllTheirLight) {
    const Environment sky(map_of(GetParam()));
    const double expected = over_the_sphere(700, [&](Vec3 d) { return sky.radiance(d).r; });
    EXPECT_NEAR(sky.total().r / expected, 1, 0.02);  // pixels against what lies between them
}

// The irradiance of a floor, by both ways to find light, against quadrature. A lamp stands under the sky as well, so
// that the choice between them is tested, too.
TEST_P(Maps, LightAFloorAsMuchAsTheyShould) {
    SceneData data;
    add(data, quad({-5, 0, -5}, {0, 0, 10}, {10, 0, 0}), diffuse(data, 1));
    data.environments.push_back(map_of(GetParam()));
    data.environments.push_back({{0.5f, 0.5f, 0.5f}});
    const Scene sky_only(data);
    add(data, quad({-1, 20, -1}, {2, 0, 0}, {0, 0, 2}), diffuse(data, 0)).emission = AreaEmission{{400, 400, 400}};
    const Scene both(data);
    const double expected =
        over_the_sphere(500,
                        [&](Vec3 d) {
                            return d.y > 0 ? double{sky_only.lights().environment(Ray{{0, 0, 0}, d}).r} * d.y : 0;
                        }) /
        std::numbers::pi;
    const double of_lamp = 400 * 4.0 / (20 * 20) / std::numbers::pi;  // nearly: it is far away
    for (const auto* scene : {&sky_only, &both}) {
        const SurfacePoint point = scene->surface(Query{.primitive = 0, .u = 0, .v = 0.5f});
        const Bsdf bsdf = scene->bsdf(point);
        double sum = 0, squares = 0;
        constexpr std::uint32_t n = 1 << 15;
        for (std::uint32_t i = 0; i < n; ++i) {
            const double value = both_ways(*scene, point, bsdf, Samples(4, i)).r;
            sum += value;
            squares += value * value;
        }
        const double mean = sum / n, error = std::sqrt((squares / n - mean * mean) / n);
        EXPECT_NEAR(mean, expected + (scene == &both ? of_lamp : 0), 4 * error + 5e-3 * expected);
        EXPECT_LT(error, 0.02 * mean);
    }
}

INSTANTIATE_TEST_SUITE_P(OfEachLayout, Maps, testing::Values(Layout::latitude_longitude, Layout::equal_area),
                         [](const auto& layout) {
                             return layout.param == Layout::equal_area ? "EqualArea" : "LatitudeLongitude";
                         });

TEST(Environment, TakesNumbersThatAreNoneForNothing) {
    EnvironmentData data;
    const float none = std::numeric_limits<float>::quiet_NaN(), all = std::numeric_limits<float>::infinity();
    data.image = std::make_shared<const Image>(2, 1, std::vector<Rgb>{{none, -1, 2}, {all, 1, 1}});
    const Environment sky(data);
    for (std::uint32_t i = 0; i < 100; ++i) {
        const Vec3 d = sphere(Samples(1, i).next_2d());
        EXPECT_TRUE(finite(sky.radiance(d)));
        EXPECT_GE(sky.radiance(d).g, 0);
        EXPECT_TRUE(std::isfinite(sky.pdf(d)));
    }
}

TEST(Environment, BearsATransformThatIsNone) {
    EnvironmentData data = map_of(Layout::equal_area);
    data.to_world.m = {};
    const Environment sky(data);
    EXPECT_TRUE(std::isfinite(sky.pdf({0, 0, 1})));
    EXPECT_TRUE(finite(sky.radiance({std::nanf(""), 0, 1})));
}

TEST(Environment, OfABlackMapIsNeverChosen) {
    SceneData data;
    data.environments.push_back({});
    data.environments[0].image = std::make_shared<const Image>(2, 1, std::vector<Rgb>(2));
    const Scene scene(data);
    EXPECT_FALSE(scene.lights().has_environment());
    EXPECT_TRUE(scene.lights().empty());
}

}  // namespace
}  // namespace lightnet::environment_test
