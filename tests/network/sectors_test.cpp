// Sectors of space, and the port that sends questions to them.
#include "core/network/light/sectors.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <limits>
#include <set>
#include <stdexcept>

#include "core/base/math/random.hpp"
#include "core/run/schedule/sector_port.hpp"

namespace lightnet::sectors_test {
namespace {

float number(Key key) { return float(mix(key) >> 40) / float(1 << 24); }

// Most of them in one corner.
std::vector<Vec3> points(std::size_t count, Key key) {
    std::vector<Vec3> points;
    for (std::size_t i = 0; i < count; ++i) {
        const Key own = child(key, i);
        const float scale = i % 4 ? 0.1f : 3;
        points.push_back({scale * number(own), scale * number(own + 1), 0.2f * scale * number(own + 2)});
    }
    return points;
}

TEST(Sectors, HaveAboutAsManyLandmarksEach) {
    for (const std::uint32_t count : {1u, 2u, 3u, 5u, 16u}) {
        const Sectors sectors(points(8000, 1), count);
        std::vector<int> inside(count);
        for (const Vec3 point : points(8000, 2)) ++inside.at(sectors.at(point));
        for (const int some : inside) EXPECT_NEAR(some, 8000.0 / count, 0.12 * 8000 / count + 20) << count;
    }
}

TEST(Sectors, CoverAllOfSpace) {
    const Sectors sectors(points(100, 1), 7);
    constexpr float far = std::numeric_limits<float>::max(), infinite = std::numeric_limits<float>::infinity();
    for (const float x : {-far, -10.0f, 10.0f, far, infinite, -infinite, std::nanf("")})
        EXPECT_LT(sectors.at({x, -x, x}), 7u);
    const Sectors none({}, 5), same(std::vector<Vec3>(10, Vec3{1, 2, 3}), 5), bad({{std::nanf(""), 0, 0}}, 3);
    EXPECT_LT(none.at({1, 1, 1}), 5u);
    EXPECT_LT(same.at({1, 2, 3}), 5u);
    EXPECT_LT(bad.at({1, 2, 3}), 3u);
}

std::set<std::uint32_t> near(const Sectors& sectors, Vec3 point, float reach) {
    std::set<std::uint32_t> found;
    sectors.near(point, reach, [&](std::uint32_t sector) { EXPECT_TRUE(found.insert(sector).second) << "once"; });
    return found;
}

TEST(Sectors, KnowAllThatIsNearToAnyOfTheirPoints) {
    const Sectors sectors(points(3000, 1), 6);
    const auto questions = points(300, 5), things = points(300, 6);
    for (const float reach : {0.0f, 0.02f, 0.5f})
        for (const Vec3 question : questions)
            for (const Vec3 thing : things)
                if (length_squared(thing - question) <= reach * reach) {
                    EXPECT_TRUE(near(sectors, thing, reach).contains(sectors.at(question)));
                }
}

// On a border, and one step of arithmetic beside it.
TEST(Sectors, KnowWhatIsExactlyWithinReachOverABorder) {
    const Sectors sectors({{0, 0, 0}, {1.1f, 0, 0}, {2.2f, 0, 0}, {3.3f, 0, 0}}, 2);
    const float border = 2.2f;
    const float below = std::nextafter(border, 0.0f), above = std::nextafter(border, 9.0f);
    EXPECT_NE(sectors.at({below, 0, 0}), sectors.at({border, 0, 0}));
    EXPECT_EQ(sectors.at({border, 0, 0}), sectors.at({above, 0, 0}));
    for (const float from : {below, border, above})
        for (const float reach : {0.1f, 0.3f, 0.7f})
            for (const float to : {from - reach, from + reach}) {
                const float way = to - from;
                if (!(way * way <= reach * reach)) continue;
                EXPECT_TRUE(near(sectors, {to, 0, 0}, reach).contains(sectors.at({from, 0, 0}))) << from << ' ' << to;
            }
}

TEST(Sectors, ShareLittleOfWhatIsFarFromTheirBorders) {
    const Sectors sectors(points(3000, 1), 4);
    std::size_t copies = 0;
    for (const Vec3 point : points(3000, 2)) copies += near(sectors, point, 0.001f).size();
    EXPECT_LT(copies, 3200u);
}

// Answers with its own number and the question's sample, when it is finished.
class Recorder final : public Port {
public:
    explicit Recorder(float number) : number_(number) {}
    Ticket begin(std::span<const Query> questions, std::span<Rgb> answers) override {
        if (broken) throw std::runtime_error("broken");
        asks.push_back({{questions.begin(), questions.end()}, answers});
        return asks.size();
    }
    void finish(Ticket ticket) override {
        if (failing) throw std::runtime_error("failed");
        ++finished;
        const auto& [questions, answers] = asks[ticket - 1];
        for (std::size_t i = 0; i < answers.size(); ++i)
            answers[i] = {number_, float(questions[i * questions.size() / answers.size()].sample), float(i % 2)};
    }
    void abandon(Ticket) noexcept override { ++abandoned; }

    struct Ask {
        std::vector<Query> questions;
        std::span<Rgb> answers;
    };
    std::vector<Ask> asks;
    int finished = 0, abandoned = 0;
    bool broken = false, failing = false;

private:
    float number_;
};

// Questions go by their primitive.
class SectorPortTest : public ::testing::Test {
protected:
    std::vector<Query> questions(const std::vector<std::uint32_t>& sectors) {
        std::vector<Query> all;
        for (const auto sector : sectors) {
            Query query;
            query.primitive = sector;
            query.sample = static_cast<std::uint32_t>(all.size());
            all.push_back(query);
        }
        return all;
    }
    Recorder a{0}, b{1}, c{2};
    SectorPort port{{&a, &b, &c}, 2, [](const Query& query) { return query.primitive; }};
};

TEST_F(SectorPortTest, PutsAnswersBackInTheOrderOfTheQuestions) {
    const std::vector<std::uint32_t> where{2, 0, 0, 2, 1, 0};
    const auto asked = questions(where);
    std::vector<Rgb> answers(12);
    const auto ticket = port.begin(asked, answers);
    EXPECT_EQ(a.asks.size() + b.asks.size() + c.asks.size(), 3u) << "all are asked before any is awaited";
    EXPECT_EQ(a.finished + b.finished + c.finished, 0);
    port.finish(ticket);
    for (std::size_t i = 0; i < 6; ++i)
        for (const std::size_t colour : {0, 1})
            EXPECT_EQ(answers[2 * i + colour], (Rgb{float(where[i]), float(i), float(colour)}));
}

TEST_F(SectorPortTest, AsksNobodyElseWhenAllLieInOneSector) {
    const auto asked = questions({1, 1, 1});
    std::vector<Rgb> answers(6);
    port.finish(port.begin(asked, answers));
    EXPECT_TRUE(a.asks.empty() && c.asks.empty());
    EXPECT_EQ(b.asks.at(0).answers.data(), answers.data()) << "nothing is copied";
    EXPECT_EQ(answers[4], (Rgb{1, 2, 0}));
}

TEST_F(SectorPortTest, HasSeveralAsksUnderWay) {
    const auto one = questions({0, 1}), other = questions({1, 2, 1});
    std::vector<Rgb> first(4), second(6);
    const auto t1 = port.begin(one, first), t2 = port.begin(other, second);
    port.finish(t2);
    port.finish(t1);
    EXPECT_EQ(first[2].r, 1);
    EXPECT_EQ(second[2].r, 2);
    std::vector<Rgb> third(4);
    port.finish(port.begin(one, third));
    EXPECT_EQ(third, first);
}

TEST_F(SectorPortTest, AbandonsWhatItHasBegunWhenItCantGoOn) {
    std::vector<Rgb> answers(6);
    const auto asked = questions({0, 1, 2});
    c.broken = true;
    EXPECT_THROW(port.begin(asked, answers), std::runtime_error);
    EXPECT_EQ(a.abandoned + b.abandoned, 2);
    c.broken = false;
    b.failing = true;
    EXPECT_THROW(port.finish(port.begin(asked, answers)), std::runtime_error);
    EXPECT_EQ(c.abandoned, 1) << "a was finished, b has failed";
    b.failing = false;
    port.abandon(port.begin(asked, answers));
    EXPECT_EQ(c.abandoned, 2);
}

}  // namespace
}  // namespace lightnet::sectors_test
