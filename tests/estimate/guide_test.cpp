// What a guide knows of light, and how directions follow it.
#include <gtest/gtest.h>

#include <limits>

#include "core/base/math/samples.hpp"
#include "core/base/math/sampling.hpp"
#include "core/estimate/guide_trial.hpp"
#include "core/estimate/guided_columns.hpp"
#include "core/estimate/light_guide.hpp"
#include "core/estimate/path_chances.hpp"
#include "tests/support/small_scenes.hpp"

namespace lightnet::guide_test {
namespace {

// Some cells with much, others with little.
GuideSquare uneven_square() {
    std::vector<double> parts(GuideSquare::cells);
    for (std::size_t i = 0; i < parts.size(); ++i) parts[i] = 0.01 + double(mix(i) % 1000) / (i % 7 + 1);
    return GuideSquare(parts);
}

TEST(GuideSquare, HasADensityOfOneOnAverage) {
    const GuideSquare square = uneven_square();
    double sum = 0;
    for (std::size_t x = 0; x < GuideSquare::side; ++x)
        for (std::size_t y = 0; y < GuideSquare::side; ++y)
            sum += square.density({(float(x) + 0.5f) / GuideSquare::side, (float(y) + 0.5f) / GuideSquare::side});
    EXPECT_NEAR(sum / GuideSquare::cells, 1, 1e-5);
}

TEST(GuideSquare, PutsAsManyPointsIntoEachCellAsItsDensitySays) {
    const GuideSquare square = uneven_square();
    constexpr std::uint32_t points = 1 << 18;
    std::vector<double> counts(GuideSquare::cells);
    for (std::uint32_t i = 0; i < points; ++i) {
        const SquarePoint at = square.warp(Samples(7, i).next_2d());
        ASSERT_TRUE(at.place.x >= 0 && at.place.x < 1 && at.place.y >= 0 && at.place.y < 1);
        ASSERT_EQ(at.density, square.density(at.place));
        ASSERT_GT(at.density, 0);
        ++counts[GuideSquare::cell_of(at.place)];
    }
    for (std::size_t cell = 0; cell < counts.size(); ++cell) {
        const Vec2 middle{(float(cell / GuideSquare::side) + 0.5f) / GuideSquare::side,
                          (float(cell % GuideSquare::side) + 0.5f) / GuideSquare::side};
        const double expected = double(square.density(middle)) * points / GuideSquare::cells;
        EXPECT_NEAR(counts[cell], expected, 5 * std::sqrt(expected) + 2) << cell;
    }
}

TEST(GuideSquare, FindsThePlaceThatTheDiskCameFrom) {
    for (std::uint32_t i = 0; i < 20000; ++i) {
        const Vec2 u = Samples(11, i).next_2d();
        const Vec2 back = from_disk(disk(u));
        EXPECT_NEAR(back.x, u.x, 1e-5);
        EXPECT_NEAR(back.y, u.y, 1e-5);
    }
    EXPECT_EQ(from_disk({0, 0}), (Vec2{0.5f, 0.5f}));
    EXPECT_LT(from_disk({1, 0}).x, 1) << "there is a cell for it";
}

GuideCell uneven_cell() { return {uneven_square(), 1}; }

// The density integrates to one over all directions, and is that of the directions that come.
TEST(GuidedPoint, FindsDirectionsWithTheDensityThatItSays) {
    const GuideCell cell = uneven_cell();
    for (const bool turned : {false, true}) {
        const GuideSide side{normalize({0.3f, -0.5f, 0.2f}), turned};
        for (const CosineChoices choices : {CosineChoices{}, {0.4f, 0.7f}, {0, 1}}) {
            const GuidedPoint point(&cell, side, choices);
            double sum = 0;
            constexpr std::uint32_t directions = 1 << 18;
            for (std::uint32_t i = 0; i < directions; ++i) {
                const Vec3 direction = sphere(Samples(5, i).next_2d());
                const float height = dot(direction, side.up) * (turned ? -1.0f : 1.0f);
                sum += point.pdf(direction, height > 0 ? height * inverse_pi : 0) * 4 * pi;
            }
            EXPECT_NEAR(sum / directions, 1, 4e-3) << turned << choices.end;
        }
        const GuidedPoint point(&cell, side, {0, 1});
        for (std::uint32_t i = 0; i < 2000; ++i) {
            const SquarePoint at = point.warped(Samples(3, i).next_2d());
            Vec3 local = cosine_hemisphere(at.place);
            if (turned) local.z = -local.z;
            const Vec3 direction = normalize(Frame::around(side.up).to_world(local));
            ASSERT_GE(point.height(direction), 0);
            const float by_itself = point.height(direction) * inverse_pi, pdf = at.density * by_itself;
            const Vec2 inner{at.place.x * 16 - std::floor(at.place.x * 16),
                             at.place.y * 16 - std::floor(at.place.y * 16)};
            const auto off_border = [](float x) { return x > 1e-3f && x < 1 - 1e-3f; };
            if (off_border(inner.x) && off_border(inner.y) && point.height(direction) > 1e-2f) {
                EXPECT_NEAR(point.pdf(direction, by_itself) / pdf, 1, 1e-4);
            }
        }
    }
}

std::vector<GuideRecord> some_records(std::size_t count) {
    std::vector<GuideRecord> records;
    for (std::uint32_t i = 0; i < count; ++i) {
        Samples numbers(9, i);
        const Vec2 where = numbers.next_2d(), place = numbers.next_2d();
        const GuideStep step{{where.x, where.y, 0}, 1, LightGuide::turn_of({{0, 0, 1}, false}), place};
        // from one side, in one half of the floor
        records.emplace_back(step, where.x < 0.5f && place.x < 0.25f ? 10.0f : 0.1f);
    }
    return records;
}

class LastFirst final : public Builders {
public:
    void each(std::size_t count, const Piece& piece) override {
        while (count > 0) piece(--count);
    }
};

TEST(GuideRecord, KeepsWhatAGuideLearnsFromInSixteenBytes) {
    for (std::uint32_t i = 0; i < 1000; ++i) {
        Samples numbers(8, i);
        const Vec2 place = numbers.next_2d();
        const GuideStep step{{1, 2, float(i)}, 0.1f + numbers.next(), i % LightGuide::turns, place};
        const float radiance = std::exp(20 * numbers.next() - 10);
        const GuideRecord record(step, radiance);
        EXPECT_EQ(record.position(), step.position);
        EXPECT_EQ(record.turn(), step.turn);
        EXPECT_NEAR(record.place().x, place.x, 1 / 128.0);
        EXPECT_NEAR(record.place().y, place.y, 1 / 128.0);
        EXPECT_NEAR(record.light() / (radiance / step.density), 1, 1 / 32.0);
    }
    EXPECT_EQ(GuideRecord(GuideStep{}, 0).light(), 0);
}

TEST(LightGuide, KnowsWhereLightComesFromAtEachPlace) {
    OneBuilder alone;
    const LightGuide guide(some_records(40000), alone);
    EXPECT_GT(guide.size(), 4u);
    const GuideSide up{{0, 0, 1}, false};
    const auto bright = guide.at({0.2f, 0.5f, 0}, up, {0, 1}), dim = guide.at({0.8f, 0.5f, 0}, up, {0, 1});
    ASSERT_TRUE(bright && dim);
    EXPECT_GT(bright.density({0.1f, 0.5f}), 5 * bright.density({0.7f, 0.5f}));
    EXPECT_NEAR(dim.density({0.1f, 0.5f}), dim.density({0.7f, 0.5f}), 0.5f);
    EXPECT_NEAR(bright.radiance(), 10.0f / 4 + 0.1f * 3 / 4, 0.3f);
    EXPECT_NEAR(dim.radiance(), 0.1f, 1e-3f);
    EXPECT_FALSE(guide.at({0.2f, 0.5f, 0}, {{0, 0, 1}, true}, {})) << "nobody was on the other side";
    EXPECT_EQ(LightGuide().find({}, up), nullptr);
}

TEST(LightGuide, DoesNotDependOnWhoBuildsItInWhichOrder) {
    const auto records = some_records(40000);
    OneBuilder alone;
    LastFirst backwards;
    const LightGuide one(records, alone), other(records, backwards);
    ASSERT_EQ(one.size(), other.size());
    const GuideSide up{{0, 0, 1}, false};
    for (std::uint32_t i = 0; i < 1000; ++i) {
        Samples numbers(4, i);
        const Vec2 where = numbers.next_2d(), place = numbers.next_2d();
        const Vec3 position{where.x, where.y, 0};
        EXPECT_EQ(one.at(position, up, {}).density(place), other.at(position, up, {}).density(place));
        EXPECT_EQ(one.find(position, up)->radiance, other.find(position, up)->radiance);
    }
}

// Points of a room, of which every third wall is unknown.
LambertianSurfaces points_of(const ColumnShape& shape) {
    LambertianSurfaces surfaces;
    for (std::uint32_t i = 0; i < lanes - 1; ++i) {
        Samples numbers(6, i);
        Hit hit;
        hit.primitive = i % 12;
        const Vec2 at = triangle(numbers.next_2d());
        hit.u = at.x, hit.v = at.y;
        surfaces.add(i, shape, hit, sphere(numbers.next_2d()));
    }
    surfaces.find_points();
    return surfaces;
}
LightGuide guide_of(const LambertianSurfaces& surfaces) {
    std::vector<GuideRecord> records;
    for (std::uint32_t i = 0; i < 60000; ++i) {
        const std::size_t point = i % surfaces.size();
        if (point / 2 % 3 == 0) continue;
        Samples numbers(9, i);
        const auto side = GuideSide::of(surfaces.normal(point), surfaces.shading(point), surfaces.outgoing(point));
        const Vec2 place = numbers.next_2d(), shift = numbers.next_2d();
        const Vec3 position = surfaces.position(point) + Vec3{0.1f * shift.x, 0.1f * shift.y, 0};
        records.emplace_back(GuideStep{position, 1, LightGuide::turn_of(side), place}, place.x * shift.x);
    }
    OneBuilder alone;
    return LightGuide(records, alone);
}

TEST(GuidedColumns, KnowWhatOnePointAloneKnowsToTheBit) {
    const Mesh walls = test::room();
    const Bsdf::Model grey = DiffuseBsdf{{0.5f, 0.5f, 0.5f}};
    ColumnShape shape;
    shape.kind = ColumnShape::Kind::lambertian;
    shape.mesh = &walls;
    shape.model = &grey;
    shape.albedo = {0.5f, 0.5f, 0.5f};
    LambertianSurfaces surfaces = points_of(shape);
    const LightGuide guide = guide_of(surfaces);
    GuidedColumns columns;
    columns.find(guide, surfaces);
    RaysToLamp rays;
    for (std::uint32_t i = 0; i < surfaces.size(); ++i) {
        Samples numbers(5, i);
        rays.direction.set(i, sphere(numbers.next_2d()));
        rays.lamp_pdf[i] = numbers.next(), rays.pdf[i] = numbers.next(), rays.bare[i] = i % 5 == 0;
        rays.from_infinity[i] = i % 3 == 0;
    }
    std::size_t known = 0;
    for (const Heuristic heuristic : {Heuristic::automatic, Heuristic::power, Heuristic::balance}) {
        columns.share(rays, heuristic);
        for (std::size_t i = 0; i < surfaces.size(); ++i)
            surfaces.set_numbers(i, Samples(4, std::uint32_t(i)).next_2d());
        columns.warp(surfaces, [](auto) { return false; });
        for (std::size_t i = 0; i < surfaces.size(); ++i) {
            const auto side = GuideSide::of(surfaces.normal(i), surfaces.shading(i), surfaces.outgoing(i));
            const auto point = guide.at(surfaces.position(i), side, {0, 1});
            ASSERT_EQ(columns.knows(i), bool(point)) << i;
            const float pdf = point ? point.pdf(rays.direction[i], rays.pdf[i]) : rays.pdf[i];
            const bool squared = squares(heuristic, rays.from_infinity[i] != 0);
            EXPECT_EQ(columns.share(i), rays.bare[i] ? 1 : share(squared, rays.lamp_pdf[i], pdf)) << i;
            const Vec2 numbers = Samples(4, std::uint32_t(i)).next_2d();
            const SquarePoint alone = point ? point.warped(numbers) : SquarePoint{numbers, 1};
            EXPECT_EQ(surfaces.numbers(i), alone.place);
            EXPECT_EQ(columns.favour(i), alone.density);
            EXPECT_EQ(columns.radiance(i), point ? point.radiance() : -1);
            EXPECT_EQ(columns.point(i, {0, 1}).pdf(rays.direction[i], rays.pdf[i]), pdf);
            known += bool(point);
        }
    }
    EXPECT_GT(known, surfaces.size() / 2) << "of both rounds";
    EXPECT_LT(known, 2 * surfaces.size());
}

TEST(LightGuide, DoesNotLearnFromWhatNoPathCanHaveFound) {
    constexpr float none = std::numeric_limits<float>::quiet_NaN(), endless = std::numeric_limits<float>::infinity();
    const GuideStep sound{{1, 2, 3}, 1, 0, {0.5f, 0.5f}};
    EXPECT_TRUE(LightGuide::learns_from({sound, 1}));
    const auto broken = [&](auto&& breaks) {
        GuideStep step = sound;
        breaks(step);
        return GuideRecord(step, 1);
    };
    const std::vector<GuideRecord> wrong{{sound, none},
                                         {sound, endless},
                                         broken([&](auto& step) { step.density = 0; }),
                                         broken([&](auto& step) { step.position.y = none; }),
                                         broken([&](auto& step) { step.turn = 0xffffffffu; }),
                                         GuideRecord(Vec3{1, 2, 3})};
    for (const auto& record : wrong) EXPECT_FALSE(LightGuide::learns_from(record));
    OneBuilder alone;
    EXPECT_EQ(LightGuide(wrong, alone).size(), 0u);
}

// Of each kind so many paths that begin at 100 points.
template <class Radiance>
GuideTrial trial_of(std::uint32_t paths, const Radiance& radiance) {
    GuideTrial trial(100);
    for (const bool guided : {false, true})
        for (std::uint32_t path = 0; path < paths; ++path)
            trial.add(GuideTrial::record_of({{radiance(path, guided), 3}, path % 100, guided}), true);
    return trial;
}

TEST(GuideTrial, ComparesTheNoiseOfGuidedPathsWithThatOfOthers) {
    const auto gain = [](float spread) {
        return trial_of(16000, [&](std::uint32_t path, bool guided) {
            return 1 + (guided ? spread : 0.8f) * (path / 100 % 2 ? 1.0f : -1.0f);
        });
    };
    const auto moment = [](double spread) {  // of light beside 1, both with the half that counts for the darkest points
        const double more = (1.5 + spread) / 1.5, less = (1.5 - spread) / 1.5;
        return (more * std::sqrt(more) + less * std::sqrt(less)) / 2 - 1;
    };
    const auto [times, error] = gain(0.4f).gain();
    EXPECT_NEAR(times, moment(0.8) / moment(0.4) / 1.3, 0.05);
    EXPECT_LT(error, 0.05) << "all points are alike";
    EXPECT_NEAR(gain(0.8f).gain().times, 1 / 1.3, 1e-2) << "guided paths take more work";
    EXPECT_EQ(GuideTrial(10).gain().times, 0) << "nothing was found";
}

TEST(GuideTrial, KnowsTheNoiseOfPathsThatNobodyGuides) {
    const auto even = trial_of(4000, [](std::uint32_t, bool guided) { return guided ? 5.0f : 1.0f; });
    const auto rare = trial_of(4000, [](std::uint32_t path, bool) { return path % 7 == 0 ? 7.0f : 0.0f; });
    EXPECT_LT(even.noise_alone().times, 0.1);
    EXPECT_GT(rare.noise_alone().times, 0.3);
    EXPECT_EQ(GuideTrial(10).noise_alone().times, 0) << "nothing was found";
}

TEST(GuideTrial, CountsPathsOfRoundsBeforeOnlyIfNobodyGuidesThem) {
    const auto varied = [](std::uint32_t path, bool guided) {
        return 1 + (guided ? 0.01f : 0.5f) * (path / 100 % 2 ? 1.0f : -1.0f);
    };
    GuideTrial trial = trial_of(4000, varied), other = trial_of(4000, varied);
    EXPECT_GT(trial.gain().times, 100);
    trial.add(GuideTrial::record_of({{1000, 3}, 7, true}), false);
    EXPECT_EQ(trial.gain().times, other.gain().times);
    trial.add(GuideTrial::record_of({{1000, 3}, 7, true}), true);
    EXPECT_LT(trial.gain().times, 100);
}

// Few paths bring much.
using Gains = std::vector<GuideTrial::Gain>;

// As measured in veach-ajar, where guided paths have 1.28 times less error x time: three of eight seeds.
TEST(GuideTrial, IsNotLostByOneRoundWhereThereIsMuchNoise) {
    EXPECT_TRUE(guide_pays(Gains{{.379, .154}}, 2.2));
    EXPECT_TRUE(guide_pays(Gains{{.99, .228}, {.53, .253}}, 2.4));
    EXPECT_TRUE(guide_pays(Gains{{.788, .192}, {1.121, .161}, {.886, .22}}, 2.6)) << "all rounds together say so";
    EXPECT_FALSE(guide_pays(Gains{{.379, .154}}, .3)) << "there is little to gain";
    EXPECT_FALSE(guide_pays(Gains{{.68, .02}}, .05));
}

TEST(GuideTrial, IsWonByTheLastRoundAlone) {
    EXPECT_TRUE(guide_pays(Gains{{.585, .139}, {.655, .221}, {1.341, .3}}, 1.7)) << "who judged before knew less";
    EXPECT_FALSE(guide_pays(Gains{{.75, .4}, {.51, .36}, {.59, .15}}, .2));
    EXPECT_FALSE(guide_pays(Gains{{0, 0}, {0, 0}, {0, 0}}, 0)) << "nothing was found";
}

TEST(GuideTrial, KnowsHowSureItIs) {
    double sum = 0, squares = 0, errors = 0;
    constexpr int trials = 40;
    for (int seed = 0; seed < trials; ++seed) {
        const auto radiance = [&](std::uint32_t path, bool guided) {
            const float u = Samples(Key(2 * seed + guided), path).next();
            return guided ? 0.5f + u : u < 0.02f ? 26.0f : 0.5f;
        };
        const auto [times, error] = trial_of(8000, radiance).gain();
        sum += times, squares += times * times, errors += error;
    }
    const double mean = sum / trials, deviation = std::sqrt(squares / trials - mean * mean);
    EXPECT_GT(mean, 5);
    EXPECT_NEAR(errors / trials / deviation, 1, 0.5);
}

TEST(ChanceByWeight, LetsNoPathWeighMoreThanOneForHavingSurvived) {
    EXPECT_EQ(chance_by_weight(chance_by_hope(1e-4f), 0.5f), 0.5f);
    EXPECT_EQ(chance_by_weight(chance_by_hope(1e-4f), 4), 1);
    EXPECT_EQ(chance_by_weight(0.3f, 0.2f), 0.3f) << "what is dim may end";
}

}  // namespace
}  // namespace lightnet::guide_test
