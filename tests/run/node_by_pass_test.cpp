// A node that is made anew for each pass.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "core/base/error.hpp"
#include "core/film/tile.hpp"
#include "core/network/light/services.hpp"
#include "core/run/assembly/node_by_pass.hpp"

namespace lightnet::node_by_pass_test {
namespace {

std::multiset<std::uint32_t> alive;

// Answers with its pass, and one more when it is prepared.
class Numbered final : public LightOp {
public:
    explicit Numbered(std::uint32_t pass) : pass_(pass) { alive.insert(pass); }
    ~Numbered() override { alive.erase(alive.find(pass_)); }
    void prepare(Services&) override { more_ = 0.5f; }
    void light(std::span<const Query> questions, std::span<Rgb> answers) const override {
        for (std::size_t i = 0; i < questions.size(); ++i) answers[i].r = float(pass_) + more_;
    }

private:
    std::uint32_t pass_;
    float more_ = 0;
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

class ByPass : public testing::Test {
protected:
    void prepare(std::uint32_t pass) {
        NoServices services;
        node.begin(pass);
        node.prepare(services);
    }
    std::vector<float> answers_to(const std::vector<std::uint32_t>& passes) const {
        std::vector<Query> questions(passes.size());
        for (std::size_t i = 0; i < passes.size(); ++i) questions[i].pass = mark_of_pass(passes[i]);
        std::vector<Rgb> answers(passes.size());
        node.light(questions, answers);
        std::vector<float> reds;
        for (const Rgb& answer : answers) reds.push_back(answer.r);
        return reds;
    }
    NodeByPass node{[](std::uint32_t pass) { return std::make_unique<Numbered>(pass); }};
};

TEST_F(ByPass, IsThatOfThePassOfEachQuestionAndOfTheOneBefore) {
    prepare(3);
    prepare(4);
    EXPECT_THAT(answers_to({4, 4, 3, 4, 3, 3}), testing::ElementsAre(4.5f, 4.5f, 3.5f, 4.5f, 3.5f, 3.5f));
    EXPECT_THAT(answers_to({4, 2, 0, 3}), testing::ElementsAre(4.5f, 0, 0, 3.5f)) << "nobody waits for older ones";
}

TEST_F(ByPass, IsNeverThereMoreThanTwice) {
    for (std::uint32_t pass = 0; pass < 50; ++pass) {
        prepare(pass);
        EXPECT_LE(alive.size(), 2u);
    }
    prepare(90);
    EXPECT_THAT(alive, testing::ElementsAre(49, 90));
}

TEST_F(ByPass, BeginsWithTheFirstQuestionOfARehearsal) {
    prepare(1);
    EXPECT_THAT(answers_to({2}), testing::ElementsAre(2.0f)) << "not prepared yet, whatever it had prepared before";
    prepare(2);
    EXPECT_THAT(answers_to({2, 1}), testing::ElementsAre(2.5f, 1.5f));
}

TEST_F(ByPass, SaysThatAQuestionHasNoPass) {
    prepare(0);
    Rgb answer;
    EXPECT_THROW(node.light(std::vector<Query>(1), {&answer, 1}), Error);
}

TEST_F(ByPass, GoesOnWhereMarksBeginAgain) {
    prepare(pass_marks - 1);
    prepare(pass_marks);
    EXPECT_EQ(mark_of_pass(pass_marks), mark_of_pass(0));
    EXPECT_THAT(answers_to({pass_marks, pass_marks - 1}),
                testing::ElementsAre(float(pass_marks) + 0.5f, float(pass_marks) - 0.5f));
    EXPECT_THAT(answers_to({pass_marks + 1}), testing::ElementsAre(float(pass_marks) + 1));
}

}  // namespace
}  // namespace lightnet::node_by_pass_test
