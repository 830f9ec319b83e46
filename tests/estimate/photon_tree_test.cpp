// Photons, found again.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <limits>
#include <thread>
#include <tuple>

#include "core/base/math/samples.hpp"
#include "core/base/unwanted.hpp"
#include "core/estimate/photon_tree.hpp"
#include "core/estimate/ranks.hpp"

namespace lightnet::photon_tree_test {
namespace {

// On a floor of 1 m², each 1 / count W.
std::vector<Photon> on_floor(std::uint32_t count, Key key, bool on_grid = false) {
    std::vector<Photon> photons;
    for (std::uint32_t i = 0; i < count; ++i) {
        const Key own = child(key, i);
        Vec2 at{float(own >> 40) / float(1 << 24), float(mix(own) >> 40) / float(1 << 24)};
        if (on_grid) at = {std::floor(at.x * 16) / 16, std::floor(at.y * 16) / 16};
        const float flux = 1 / float(count);
        photons.push_back({{at.x, 0, at.y}, {flux, flux, flux}, normalize({0.3f, 1, 0.2f}), {0, 1, 0}});
    }
    return photons;
}

Rgb seen(const PhotonTree& tree, Vec3 at, float radius, std::size_t most) {
    const Bsdf bsdf(Frame::around({0, 1, 0}), {0, 1, 0}, DiffuseBsdf{{0.8f, 0.8f, 0.8f}});
    SurfacePoint point;
    point.position = at;
    point.normal = {0, 1, 0};
    Nearest scratch;
    return tree.radiance({point, bsdf, {0, 1, 0}, lobe::rough}, radius, most, scratch);
}

TEST(Photon, KeepsItsDirections) {
    for (std::uint32_t i = 0; i < 1000; ++i) {
        const auto part = [&](unsigned k) { return float(mix(7 + 3 * i + k) >> 40) / float(1 << 23) - 1; };
        const Vec3 d = normalize({part(0), part(1), part(2)}), n = normalize({part(1), part(2), -part(0)});
        const Photon photon({}, {}, d, n);
        EXPECT_GT(dot(photon.towards_light(), d), 1 - 1e-6f);
        EXPECT_NEAR(photon.cosine_to(n), 1, 0.02f);
    }
}

TEST(PhotonTree, IsNotBuiltWhenNobodyWantsItAnyMore) {
    const std::atomic<bool> unwanted = true;
    const LookingAt looking(&unwanted);
    for (const std::uint32_t count : {100u, 100'000u}) EXPECT_THROW(PhotonTree{on_floor(count, 1)}, Cancelled);
}

TEST(PhotonTree, FindsTheNearestWithTiesByWhatTheyAre) {
    for (const bool on_grid : {false, true}) {
        const PhotonTree tree(on_floor(3000, 1, on_grid));
        for (std::uint32_t i = 0; i < 50; ++i) {
            const Vec2 at{float(mix(99 + 2 * i) >> 40) / float(1 << 24),
                          float(mix(100 + 2 * i) >> 40) / float(1 << 24)};
            Nearest scratch;
            std::vector<Nearest::Item> all;
            const PhotonTree::Wanted wanted{{at.x, 0, at.y}, {0, 1, 0}, 0.2f, 40};
            const auto found = tree.find(wanted, scratch);
            for (std::uint32_t k = 0; k < tree.size(); ++k) {
                const float d = length_squared(tree[k].position - wanted.position);
                if (d <= wanted.radius * wanted.radius) all.push_back({d, k});
            }
            std::sort(all.begin(), all.end(), [&](const auto& a, const auto& b) {
                const auto rank = [&](const Nearest::Item& near) {
                    const Vec3 where = tree[near.index].position;
                    return std::tuple(near.distance2, where.x, where.y, where.z);
                };
                return rank(a) < rank(b);
            });
            all.resize(std::min<std::size_t>(all.size(), wanted.most));
            ASSERT_EQ(found.size(), all.size());
            for (std::size_t k = 0; k < all.size(); ++k) {
                EXPECT_EQ(tree[found[k].index].position, tree[all[k].index].position);
                EXPECT_EQ(found[k].distance2, all[k].distance2);
            }
        }
    }
}

// In space, on surfaces turned every way: the boxes that are passed over must have none that is near.
TEST(PhotonTree, FindsAllThatCountsAsNearInSpace) {
    const auto part = [](std::uint64_t i) { return float(mix(i) >> 40) / float(1 << 23) - 1; };
    const auto direction = [&](std::uint64_t i) { return normalize({part(3 * i), part(3 * i + 1), part(3 * i + 2)}); };
    for (const std::size_t count : {1, 15, 16, 17, 129, 5000}) {
        std::vector<Photon> photons;
        for (std::size_t i = 0; i < count; ++i)
            photons.push_back({{part(7 * i), part(7 * i + 1), part(7 * i + 2)}, {1, 1, 1}, {0, 0, 1}, direction(i)});
        const PhotonTree tree(photons);
        Nearest scratch;
        for (const float radius : {0.1f, 0.7f, 1e30f})
            for (const std::size_t most : {0, 1, 5, 50, 300})
                for (std::uint64_t i = 0; i < 20; ++i) {
                    const PhotonTree::Wanted wanted{{part(i), part(i + 90), part(i + 50)}, direction(i), radius, most};
                    std::vector<float> all, found;
                    for (const Photon& photon : photons) {
                        const Vec3 way = photon.position - wanted.position;
                        const float height = dot(way, wanted.normal);
                        const float d = length_squared(way) + 15 * height * height;
                        if (std::fabs(photon.cosine_to(wanted.normal)) >= 0.7f && d <= radius * radius)
                            all.push_back(d);
                    }
                    std::sort(all.begin(), all.end());
                    if (most) all.resize(std::min(all.size(), most));
                    for (const auto& near : tree.find(wanted, scratch)) found.push_back(near.distance2);
                    ASSERT_EQ(found, all) << count << " photons, at most " << most << " within " << radius;
                }
    }
}

TEST(Ranks, AreOrderOrSayThatSomeAreEqual) {
    std::array<float, 16> values;
    values.fill(std::numeric_limits<float>::infinity());
    std::ranges::copy(std::array{7.0f, -3.0f, 0.0f, 2.0f}, values.begin());
    const Ranks<32> ranks(values.data(), 4, 16);
    EXPECT_TRUE(ranks.all_differ());
    for (std::size_t i = 0; i < 4; ++i) {
        const auto less = [&](std::size_t k) { return values[k] < values[i]; };
        EXPECT_EQ(ranks[i], less(0) + less(1) + less(2) + less(3));
    }
    values[1] = values[2];
    EXPECT_FALSE(Ranks<32>(values.data(), 4, 16).all_differ());
    values.fill(std::numeric_limits<float>::infinity());
    EXPECT_TRUE(Ranks<32>(values.data(), 0, 16).all_differ());
    values[0] = 1;
    EXPECT_TRUE(Ranks<32>(values.data(), 1, 16).all_differ());
}

/// A thread for each piece.
class ManyBuilders final : public Builders {
public:
    void each(std::size_t count, const Piece& piece) override {
        std::vector<std::jthread> threads;
        for (std::size_t i = 0; i < count; ++i) threads.emplace_back([&piece, i] { piece(i); });
        most = std::max(most, count);
    }
    std::size_t most = 0;
};

TEST(PhotonTree, DependsNeitherOnTheOrderOfPhotonsNorOnThoseWhoBuildIt) {
    for (const bool on_grid : {false, true}) {
        auto photons = on_floor(100000, 2, on_grid);
        const PhotonTree one(photons);
        std::reverse(photons.begin(), photons.end());
        ManyBuilders many;
        const PhotonTree other(photons, many);
        EXPECT_GE(many.most, 4u);
        for (std::size_t i = 0; i < one.size(); ++i) EXPECT_EQ(one[i].position, other[i].position);
    }
}

// The bytes of a sharded map are those of a whole one.
TEST(PhotonTree, FindsTheSameAmongSomePhotonsAsAmongAllWhenNoneIsMissingThatIsNear) {
    const auto all = on_floor(3000, 5, true);
    auto some = all;
    std::erase_if(some, [](const Photon& photon) { return photon.position.x > 0.7f; });
    const PhotonTree whole(all), part(some);
    for (const std::size_t most : {0, 7, 40})
        for (std::uint32_t i = 0; i < 200; ++i) {
            const Vec3 at{0.45f * float(mix(2 * i) >> 40) / float(1 << 24), 0,
                          float(mix(2 * i + 1) >> 40) / float(1 << 24)};
            EXPECT_EQ(seen(whole, at, 0.25f, most), seen(part, at, 0.25f, most)) << i << " of " << most;
        }
}

TEST(PhotonTree, PassesOverPhotonsOfOtherSurfaces) {
    auto photons = on_floor(100, 3);
    for (auto& photon : photons) photon = Photon(photon.position, photon.flux, {1, 0, 0}, {1, 0, 0});
    const PhotonTree tree(photons);
    Nearest scratch;
    const auto found = tree.find({{0.5f, 0, 0.5f}, {0, 1, 0}, 1, 0}, scratch);
    EXPECT_TRUE(found.empty());
}

// 1 W on 1 m² of albedo 0.8: 0.8/π everywhere. The estimates at points far from each other are independent, so the
// bound is four standard deviations of their mean. An estimate from k photons varies by about √(4/3k).
TEST(PhotonTree, SeesAnEvenlyLitPlaneAsBrightAsItIs) {
    const double exact = 0.8 / 3.14159265358979;
    for (const auto& [radius, most] : {std::pair(0.05f, std::size_t{0}), std::pair(1.0f, std::size_t{60})}) {
        double sum = 0;
        int points = 0;
        for (Key key = 0; key < 20; ++key) {
            const PhotonTree tree(on_floor(8000, 1000 * key));
            for (const float x : {0.2f, 0.4f, 0.6f, 0.8f})
                for (const float z : {0.2f, 0.4f, 0.6f, 0.8f}) {
                    sum += seen(tree, {x, 0, z}, radius, most).g;
                    ++points;
                }
        }
        EXPECT_NEAR(sum / points, exact, 4 * exact * std::sqrt(4 / 3.0 / 60 / points)) << "of " << most;
    }
}

// Beside a sharp edge the estimate is too bright or too dark by how far it looks; more photons let it look less far.
TEST(PhotonTree, SeesEdgesSharperTheMorePhotonsThereAre) {
    const auto error = [](std::uint32_t count) {
        double sum = 0;
        for (Key key = 0; key < 8; ++key) {
            auto photons = on_floor(count, 77 * key);
            std::erase_if(photons, [](const Photon& photon) { return photon.position.x > 0.5f; });
            const PhotonTree tree(photons);
            for (int i = 0; i < 20; ++i) {
                const float x = 0.4f + 0.01f * float(i), z = 0.5f;
                const double exact = x < 0.5f ? 0.8 / 3.14159265358979 : 0;
                sum += std::fabs(seen(tree, {x, 0, z}, 0.3f, 50).g - exact);
            }
        }
        return sum;
    };
    const double few = error(1000), many = error(64000);
    EXPECT_LT(many, 0.4 * few);
}

}  // namespace
}  // namespace lightnet::photon_tree_test
