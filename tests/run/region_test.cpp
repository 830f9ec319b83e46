#include "core/run/message/region.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <set>

namespace lightnet::region_test {
namespace {

std::uint64_t at(float u, float v) {
    Query query;
    query.u = u, query.v = v;
    return region_of(query);
}

TEST(Region, IsAQuarterByAQuarterOfAPrimitive) {
    EXPECT_EQ(at(0.1f, 0.1f), at(0.2f, 0.2f));
    std::set<std::uint64_t> all;
    for (const float u : {0.1f, 0.3f, 0.6f, 0.9f})
        for (const float v : {0.1f, 0.3f, 0.6f, 0.9f}) all.insert(at(u, v));
    EXPECT_EQ(all.size(), 16u);
    Query other;
    other.primitive = 64;
    EXPECT_NE(region_of(other), at(0, 0));
}

TEST(Region, IsThereForSpheresAndForWhatIsNoPlace) {
    EXPECT_NE(at(-0.9f, 0), at(-0.3f, 0)) << "spheres have negative coordinates";
    constexpr float most = std::numeric_limits<float>::max(), none = std::numeric_limits<float>::quiet_NaN();
    EXPECT_EQ(at(most, -most), at(1, -1));
    EXPECT_EQ(at(none, none), at(-1, -1));
}

}  // namespace
}  // namespace lightnet::region_test
