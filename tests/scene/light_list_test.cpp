// A light without a surface is one file and one word in a list.
#include <gtest/gtest.h>

#include <concepts>
#include <set>
#include <string>
#include <variant>
#include <vector>

#include "core/scene/bare_lights/moving_light.hpp"
#include "tests/scene/beam_light.hpp"

namespace lightnet::light_list_test {
namespace {

// The list of a product that has beams, too.
using Longer = std::variant<SpotLight, DirectionalLight, BeamLight>;
static_assert(
    std::same_as<NearLightsOf<Longer>::type,
                 std::variant<SpotLight, SlideLight, MovingLight<SpotLight>, BeamLight, MovingLight<BeamLight>>>,
    "what lights at a place are found by, still and moving");

struct NamelessLight : BeamLight {
    static constexpr int name = 0;
};
struct FixedLight : BeamLight {
    void between(const StepPlace&, const FixedLight&) const = delete;
};
struct NowhereLight {
    static constexpr const char* name = "neither at a place nor from infinity";
    LampLabel label;
    Rgb brightness;
    const char* names() const { return name; }
    Rgb& strength() { return brightness; }
};
void visit_members(Is<NowhereLight> auto&, const auto&) {}
struct UnlistedLight {
    static constexpr const char* name = "does not list its members";
    LampLabel label;
    Rgb brightness;
    const char* names() const { return name; }
    Rgb& strength() { return brightness; }
    SunDisk disk() const { return {}; }
};
static_assert(IsLight<BeamLight> && IsNearLight<BeamLight> && !IsLight<NamelessLight> && !IsLight<FixedLight> &&
                  !IsLight<NowhereLight> && !IsLight<UnlistedLight>,
              "who forgets something does not compile");

TEST(ALightOfItsOwn, ShinesFromWhereItIsAtTheTime) {
    const BeamLight first{{0, 0, 5}, {0, 0, -1}, {3, 2, 1}, 0.5f};
    BeamLight last = first;
    last.position = {4, 0, 5};
    const std::vector<Longer> later{last};
    const MovingLight<BeamLight> moving(first, std::span(later));
    EXPECT_TRUE(moving.from({0, 0, 0}, 0));
    EXPECT_FALSE(moving.from({0, 0, 0}, shutter_closes));
    const auto halfway = moving.from({2.25f, 0, 0}, shutter_closes / 2);
    ASSERT_TRUE(halfway);
    EXPECT_EQ(halfway->direction, (Vec3{0, 0, 1}));
    EXPECT_EQ(halfway->radiance, (Rgb{3, 2, 1}));
    EXPECT_EQ(moving.bounds().high.x, 4.5f);
    EXPECT_NEAR(moving.emission({0.5f, 0.5f}, shutter_closes).origin.x, 4, 0.5);
}

TEST(EveryLightOfTheList, HasANameOfItsOwn) {
    const auto names = []<class... Lights>(std::variant<Lights...>*) {
        return std::set<std::string>{Lights::name...};
    }(static_cast<BareLight*>(nullptr));
    EXPECT_EQ(names.size(), std::variant_size_v<BareLight>);
}

}  // namespace
}  // namespace lightnet::light_list_test
