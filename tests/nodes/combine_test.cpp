#include <gtest/gtest.h>

#include "core/base/error.hpp"
#include "tests/support/rig.hpp"
#include "tests/support/small_scenes.hpp"

namespace lightnet::combine_test {
namespace {

using namespace test;

class Constant final : public LightOp {
public:
    explicit Constant(float value) : value_(value) {}
    void light(std::span<const Query>, std::span<Rgb> answers) const override {
        std::fill(answers.begin(), answers.end(), Rgb{value_, 2 * value_, 0});
    }

private:
    float value_;
};

class Combining : public testing::Test {
protected:
    std::vector<Rgb> ask(const Table& weights, bool layered) {
        const auto kinds = standard_nodes();
        const auto kind = std::find_if(kinds.begin(), kinds.end(), [](const Kind& k) { return k.name == "Combine"; });
        const Node node{"sum", "Combine", {}, {{"weights", Value{weights}}}, {}};
        Inputs inputs({{"a", &first_port_, {0}}, {"b", &second_port_, {layered ? 1u : 0u}}}, layered ? 2 : 1);
        const auto op = kind->make_light(NodeContext(node, std::move(inputs), scene_, 1));
        std::vector<Rgb> answers(layered ? 4 : 2);
        op->light(std::vector<Query>(2), answers);
        return answers;
    }

    Scene scene_{SceneData{}};
    Constant first_{1}, second_{10};
    test::CallPort first_port_{first_}, second_port_{second_};
};

TEST_F(Combining, AddsUpItsInputs) { EXPECT_EQ(ask({}, false), (std::vector<Rgb>{{11, 22, 0}, {11, 22, 0}})); }

TEST_F(Combining, WeighsItsInputs) {
    EXPECT_EQ(ask({{Value{2.0}, Value{0.5}}, {}}, false), (std::vector<Rgb>{{7, 14, 0}, {7, 14, 0}}));
}

TEST_F(Combining, KeepsLayersApart) {
    EXPECT_EQ(ask({}, true), (std::vector<Rgb>{{1, 2, 0}, {10, 20, 0}, {1, 2, 0}, {10, 20, 0}}));
}

TEST_F(Combining, RefusesWeightsThatDoNotFitItsInputs) { EXPECT_THROW(ask({{Value{2.0}}, {}}, false), Error); }

}  // namespace
}  // namespace lightnet::combine_test
