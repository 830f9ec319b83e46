// A material is one file and one word in a list.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <vector>

#include "core/scene/bsdf/bsdf.hpp"
#include "tests/scene/bsdf/veil.hpp"

namespace lightnet::material_list_test {
namespace {

using testing::ElementsAre;

// The list of a product that has veils, too.
using Longer = std::variant<DiffuseMaterial, VeilMaterial, MixtureMaterial, DielectricMaterial, NoMaterial>;
static_assert(std::same_as<ModelsOf<Longer>::type, std::variant<DiffuseBsdf, RoughDiffuseBsdf, DiffuseTransmissionBsdf,
                                                                VeilBsdf, DielectricBsdf, ThinDielectricBsdf>>,
              "each model once, as materials name them");
static_assert(choosing<ModelsOf<Longer>::type>[2] && !choosing<ModelsOf<Longer>::type>[3]);
static_assert(std::same_as<std::variant_alternative_t<0, Bsdf::Model>, DiffuseBsdf>);

struct Nameless : VeilMaterial {
    static constexpr int name = 0;
};
struct Shapeless {
    static constexpr const char* name = "neither scatters nor blends";
    Transparency transparency() const { return Transparency::opaque; }
};
void visit_members(Is<Shapeless> auto&, const auto&) {}
struct Unlisted {
    static constexpr const char* name = "does not list its members";
    Transparency transparency() const { return Transparency::opaque; }
    VeilBsdf at(const MaterialInputs&) const { return {}; }
};
static_assert(IsMaterial<VeilMaterial> && !IsMaterial<Nameless> && !IsMaterial<Shapeless> && !IsMaterial<Unlisted>,
              "who forgets something does not compile");

TEST(AMaterialOfItsOwn, ShowsItsTexturesAndScatters) {
    const Longer veil = VeilMaterial{1};
    std::vector<std::uint32_t> textures;
    visit_each<TextureId>(veil, [&](TextureId id) { textures.push_back(id); });
    EXPECT_THAT(textures, ElementsAre(1));
    const std::vector<Texture> colours{Texture{}, Texture{{0.5f, 2, 1}, {}, false}};
    const auto sample = std::get<VeilMaterial>(veil).at({colours, {}}).sample({0, 0, 1}, 0, {}, lobe::all);
    ASSERT_TRUE(sample);
    EXPECT_EQ(sample->incoming.z, -1);
    EXPECT_EQ(sample->weight, (Rgb{0.5f, 1, 1}));
}

template <class Material>
class EveryMaterial : public testing::Test {};
template <class List>
struct TypesOf;
template <class... Materials>
struct TypesOf<std::variant<Materials...>> {
    using type = testing::Types<Materials...>;
};
TYPED_TEST_SUITE(EveryMaterial, TypesOf<AnyMaterial>::type);

// What lies between the members that are shown is too small for one that is not, but a byte beside a byte.
TYPED_TEST(EveryMaterial, ShowsAllOfItsMembers) {
    if (std::is_empty_v<TypeParam>) return;
    struct Range {
        std::size_t begin, end, alignment;
    };
    const TypeParam material{};
    std::vector<Range> members;
    visit_members(material, [&](const auto&... each) {
        const auto add = [&]<class Member>(const Member& member) {
            const auto begin =
                std::size_t(reinterpret_cast<const char*>(&member) - reinterpret_cast<const char*>(&material));
            members.push_back({begin, begin + sizeof(Member), alignof(Member)});
        };
        (add(each), ...);
    });
    std::ranges::sort(members, {}, &Range::begin);
    members.push_back({sizeof(TypeParam), sizeof(TypeParam), alignof(TypeParam)});
    std::size_t at = 0;
    for (const Range& member : members) {
        EXPECT_LE(at, member.begin) << "a member is shown twice";
        EXPECT_LT(member.begin - at, member.alignment) << "behind byte " << at;
        at = member.end;
    }
}

TEST(EveryMaterialOfTheList, HasANameOfItsOwn) {
    const auto names = []<class... Materials>(std::variant<Materials...>*) {
        return std::set<std::string>{Materials::name...};
    }(static_cast<AnyMaterial*>(nullptr));
    EXPECT_EQ(names.size(), std::variant_size_v<AnyMaterial>);
}

}  // namespace
}  // namespace lightnet::material_list_test
