// A node that leaves its place, with those who know it.
#include "core/run/assembly/node_that_leaves.hpp"

#include <gtest/gtest.h>

#include <array>

#include "core/base/error.hpp"
#include "core/network/light/services.hpp"
#include "core/run/assembly/shared_values.hpp"

namespace lightnet::node_that_leaves_test {
namespace {

int alive = 0;

class Counted final : public LightOp {
public:
    explicit Counted(const std::function<void()>& inside) : inside_(inside) { ++alive; }
    ~Counted() override { --alive; }
    void light(std::span<const Query>, std::span<Rgb> answers) const override {
        if (inside_) inside_();
        answers[0] = Rgb(float(alive), 0, 0);
    }

private:
    const std::function<void()>& inside_;
};

class NoServices final : public Services {
public:
    std::vector<Query> rehearse(std::uint32_t) override { return {}; }
    void say(const std::string&) override {}
    void doing(const std::string&, std::uint64_t, std::uint64_t) override {}
    void look() const override {}

protected:
    Bytes map_bytes(std::size_t, const Shard&) override { return nullptr; }
    std::shared_ptr<const void> once_any(const Make&) override { return nullptr; }
};

TEST(NodeThatLeaves, IsGoneAtOnceWhereNobodyIsInIt) {
    const std::function<void()> nothing;
    NodeThatLeaves node([&] { return std::make_unique<Counted>(nothing); });
    EXPECT_EQ(alive, 1);
    EXPECT_FALSE(node.has_left());
    node.leave();
    EXPECT_EQ(alive, 0);
    EXPECT_TRUE(node.has_left());
    std::array<Rgb, 1> answers;
    EXPECT_THROW(node.light({}, answers), Error);
}

TEST(NodeThatLeaves, StaysUntilACallHasReturned) {
    NodeThatLeaves* self = nullptr;
    const std::function<void()> leaves = [&] { self->leave(); };
    NodeThatLeaves node([&] { return std::make_unique<Counted>(leaves); });
    self = &node;
    std::array<Rgb, 1> answers;
    node.light({}, answers);
    EXPECT_EQ(answers[0], Rgb(1, 0, 0));
    EXPECT_EQ(alive, 0);
}

TEST(NodeThatLeaves, IsMadeAnewWhereItComesBack) {
    const std::function<void()> nothing;
    NodeThatLeaves node([&] { return std::make_unique<Counted>(nothing); });
    node.leave();
    NoServices services;
    node.prepare(services);
    EXPECT_EQ(alive, 1);
    std::array<Rgb, 1> answers;
    node.light({}, answers);
    EXPECT_EQ(answers[0], Rgb(1, 0, 0));
}

TEST(SharedValues, ForgetsThoseOfANodeAlone) {
    SharedValues values;
    const auto make = [](Builders&) -> SharedValues::Value { return std::make_shared<int>(7); };
    for (const std::size_t node : {1, 2, 3})
        for (const std::uint32_t index : {0, 1}) values.get(node, index, {}, make);
    const auto held = values.get(2, 0, {}, make);
    values.forget(2);
    EXPECT_EQ(values.size(), 4u);
    EXPECT_EQ(*std::static_pointer_cast<const int>(held), 7) << "who looks at it still has it";
}

}  // namespace
}  // namespace lightnet::node_that_leaves_test
