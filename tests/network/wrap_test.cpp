// Classes that know nothing of lightnet, as nodes.
#include "core/network/light/wrap.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>

#include "core/base/error.hpp"
#include "core/network/light/light_op.hpp"
#include "core/network/light/locks.hpp"
#include "core/network/light/renderer.hpp"
#include "core/run/fiber/fiber.hpp"
#include "core/run/fiber/rounds.hpp"
#include "core/scene/scene.hpp"
#include "tests/support/small_scenes.hpp"

namespace old {

// What a library of another time might have.
struct Source {
    virtual ~Source() = default;
    virtual double brightness(int place) = 0;
};

/// Remembers how often it was asked, for no use to anybody but itself.
class Doubler {
public:
    explicit Doubler(Source& source) : source_(source) {}
    double brightness(int place) {
        ++asked_;
        scratch_ = source_.brightness(place);
        return scratch_ + source_.brightness(place + 1);
    }

private:
    Source& source_;
    double scratch_ = 0;
    int asked_ = 0;
};

/// Answers depend on what it was asked before.
class Tired {
public:
    explicit Tired(Source&) {}
    double brightness(int) { return 1.0 / ++asked_; }

private:
    int asked_ = 0;
};

class Picky {
public:
    explicit Picky(Source&) {}
    double brightness(int place) {
        if (place == 7) throw "not there";
        if (place == 8) throw std::out_of_range("there is no eighth place");
        return place;
    }
};

class Eye {
public:
    double see(double x, double y, unsigned seed) { return x + 100 * y + 0 * seed; }
};

}  // namespace old

namespace lightnet {

// All of the library that answers for places.
template <class T>
requires std::constructible_from<T, old::Source&>
struct Bridge<T> {
    class Input final : public old::Source {
    public:
        explicit Input(OneByOne& inputs) : inputs_(inputs) {}
        double brightness(int place) override {
            return inputs_.ask(0, Query{.primitive = static_cast<std::uint32_t>(place)}).r;
        }

    private:
        OneByOne& inputs_;
    };

    Bridge(const NodeContext&, OneByOne& inputs) : input_(inputs), instance_(input_) {}
    Rgb light(const Query& question) {
        return {static_cast<float>(instance_.brightness(static_cast<int>(question.primitive))), 0, 0};
    }

    Input input_;
    T instance_;
};

template <>
struct Bridge<old::Eye> {
    Bridge(const NodeContext&, OneByOne& inputs) : inputs_(inputs) {}
    Rgb sample(const PixelSample& at) {
        return {static_cast<float>(eye_.see(at.x, at.y, static_cast<unsigned>(inputs_.seed()))), 0, 0};
    }

    OneByOne& inputs_;
    old::Eye eye_;
};

}  // namespace lightnet

namespace lightnet::wrap_test {
namespace {

// Answers with ten times the primitive; parks, as an input elsewhere would.
class Elsewhere final : public Port {
public:
    Ticket begin(std::span<const Query> questions, std::span<Rgb> answers) override {
        for (std::size_t i = 0; i < questions.size(); ++i) {
            answers[i] = {10.0f * static_cast<float>(questions[i].primitive), 0, 0};
            streams.push_back(questions[i].stream);
        }
        return 1;
    }
    void finish(Ticket) override {
        if (!fibers || !fibers->current()) return;
        waiting.push_back(fibers->current());
        fibers->park();
    }
    void abandon(Ticket) noexcept override {}

    Fibers* fibers = nullptr;
    std::vector<Fibers::Fiber*> waiting;
    std::vector<Key> streams;
};

class WrapTest : public ::testing::Test {
protected:
    ~WrapTest() override { fibers.cancel_all(); }

    NodeContext here(NodeServices lent = {}) { return {node, Inputs({{"elsewhere", &port, {0}}}, 1), scene, 1, lent}; }
    static std::vector<Query> questions(std::uint32_t count) {
        std::vector<Query> all(count);
        for (std::uint32_t i = 0; i < count; ++i) all[i].primitive = i, all[i].stream = mix(i + 1);
        return all;
    }
    static std::vector<Rgb> answers_of(const LightOp& light, const std::vector<Query>& questions) {
        std::vector<Rgb> answers(questions.size());
        light.light(questions, answers);
        return answers;
    }

    Scene scene{test::furnace(0.5f, 1)};
    Node node{"doubler", "Doubler", {}, {}, {}};
    Elsewhere port;
    Fibers fibers;
};

TEST_F(WrapTest, MakesANodeOfAClassByOneLine) {
    const Kind kind = wrap<old::Doubler>("Doubler", {.help = "adds up neighbours", .inputs = {1, 1}});
    EXPECT_EQ(kind.name, "Doubler");
    EXPECT_EQ(kind.inputs.least, 1u);
    EXPECT_EQ(kind.inputs.most, 1u);
    const auto light = kind.make_light(here());
    EXPECT_EQ(answers_of(*light, questions(3)), (std::vector<Rgb>{{10, 0, 0}, {30, 0, 0}, {50, 0, 0}}));
}

TEST_F(WrapTest, AsksTheInputsOfAllQuestionsBeforeAnyIsAnswered) {
    const auto q = questions(100);
    const auto serially = answers_of(*wrap<old::Doubler>("Doubler", {}).make_light(here()), q);
    const auto streams = std::exchange(port.streams, {});

    port.fibers = &fibers;
    std::vector<Fibers::Fiber*> ready;
    Rounds rounds(fibers, 1000, [&](Fibers::Fiber* fiber) { ready.push_back(fiber); });
    const auto light = wrap<old::Doubler>("Doubler", {}).make_light(here({.concurrent = &rounds}));
    std::vector<Rgb> answers;
    fibers.start("doubler", [&] { answers = answers_of(*light, q); });
    while (rounds.start_one()) {
    }
    EXPECT_EQ(port.waiting.size(), 100u);
    while (!port.waiting.empty() || !ready.empty()) {
        auto& from = ready.empty() ? port.waiting : ready;
        auto* const fiber = from.back();  // the last first: order must not matter
        from.pop_back();
        fibers.resume(fiber);
    }
    EXPECT_EQ(answers, serially);
    EXPECT_THAT(port.streams, testing::UnorderedElementsAreArray(streams))
        << "keys come from questions, not from order";
}

TEST_F(WrapTest, NamesTheQuestionWhateverTheClassThrows) {
    const auto light = wrap<old::Picky>("Picky", {}).make_light(here());
    for (const auto& [place, what] : {std::pair{7u, "no std::exception"}, {8u, "there is no eighth place"}}) try {
            answers_of(*light, {Query{.geometry = 3, .primitive = place, .sample = 5}});
            ADD_FAILURE() << "it should have thrown";
        } catch (const Error& error) {
            EXPECT_THAT(error.what(),
                        testing::HasSubstr("shape 3, primitive " + std::to_string(place) + ", uv (0, 0), sample 5"));
            EXPECT_THAT(error.what(), testing::HasSubstr(what));
        }
}

TEST_F(WrapTest, CatchesAClassWhoseHistoryChangesAnswers) {
    const auto q = questions(200);
    EXPECT_NO_THROW(answers_of(*wrap<old::Doubler>("Doubler", {}).make_light(here({.checking = true})), q));
    const auto tired = wrap<old::Tired>("Tired", {});
    EXPECT_NO_THROW(answers_of(*tired.make_light(here()), q)) << "only a checking run looks";
    try {
        answers_of(*tired.make_light(here({.checking = true})), q);
        ADD_FAILURE() << "it should have been caught";
    } catch (const Error& error) {
        EXPECT_THAT(error.what(), testing::HasSubstr("what the class remembers must not change answers"));
    }
}

TEST_F(WrapTest, AnswersBlackAndCountsWhereThereIsNoSurfaceToAskAbout) {
    std::uint64_t count = 0;
    const NodeContext context = here({.off_surface = &count});
    OneByOne inputs(context);
    inputs.begin(1, 0);
    EXPECT_EQ(inputs.ask(0, std::optional(Query{.primitive = 3})), (Rgb{30, 0, 0}));
    EXPECT_EQ(count, 0u);
    EXPECT_EQ(inputs.ask(0, std::optional<Query>{}), (Rgb{}));
    EXPECT_EQ(count, 1u);
}

// Tells by whom it is held.
class Watched final : public Locks {
public:
    std::vector<std::string> names;
    int held = 0;

protected:
    const void* worker() const override { return nullptr; }
    void wait_for(const std::string& name) override { names.push_back(name), ++held; }
    void give_back(const std::string&) noexcept override { --held; }
};

TEST_F(WrapTest, LetsCallsOfAProcessThatShareGlobalsGoOnOneAtATime) {
    Watched locks;
    const Kind kind = wrap<old::Picky>("Picky", {.help = "x", .alone = "globals"});
    EXPECT_TRUE(kind.run.locks);
    EXPECT_FALSE(wrap<old::Picky>("Picky", {}).run.locks);
    const auto light =
        kind.make_light(here({.locks = &locks, .whereabouts = [] { return Whereabouts{.process = "onyx1 4711"}; }}));
    EXPECT_EQ(answers_of(*light, questions(5)).size(), 5u);
    EXPECT_EQ(locks.names, std::vector<std::string>{"globals of onyx1 4711"}) << "once for all questions of a call";
    EXPECT_EQ(locks.held, 0);
}

TEST_F(WrapTest, MakesARendererOfAClassThatSeesOneRayAtATime) {
    const Kind kind = wrap<old::Eye>("Eye", {.help = "looks"});
    EXPECT_EQ(kind.role, Role::image);
    EXPECT_TRUE(kind.light.merges);
    const auto eye = kind.make_renderer(here());
    std::vector<Rgb> pixels(6);
    eye->render(Tile{4, 2, 3, 2, 0, 4}, pixels);
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        const float x = 4.0f + float(i % 3), y = 2.0f + float(i / 3);
        EXPECT_GE(pixels[i].r, 4 * (x + 100 * y)) << "the sum of four samples within the pixel";
        EXPECT_LE(pixels[i].r, 4 * (x + 1 + 100 * (y + 1)));
    }
}

}  // namespace
}  // namespace lightnet::wrap_test
