// A place whose helper the test plays: what it gives away, keeps, and tells of.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

#include "core/network/light/light_op.hpp"
#include "core/network/light/node_context.hpp"
#include "core/network/light/renderer.hpp"
#include "core/run/place/place.hpp"
#include "tests/support/slowdown.hpp"
#include "tests/support/small_scenes.hpp"

namespace lightnet::place_relief_test {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

constexpr std::uint32_t inner = 0, dear = 1, image = 2;  // in the graph

// What the nodes of the test do. A place calls them on its thread.
struct Doing {
    std::chrono::nanoseconds cost{0};         // of a question to "dear"
    std::vector<std::size_t> pieces;          // questions that it was called with
    std::vector<std::size_t> asked_together;  // that "inner" was
    std::size_t asks_on = 0;                  // questions for each of its own
};
Doing doing;

class Dear final : public LightOp {
public:
    explicit Dear(const NodeContext& here) : inputs_(here.inputs()) {}
    void light(std::span<const Query> questions, std::span<Rgb> answers) const override {
        doing.pieces.push_back(questions.size());
        std::this_thread::sleep_for(doing.cost * questions.size());
        if (doing.asks_on == 0) return;
        std::vector<Query> on;
        for (const auto& question : questions) on.insert(on.end(), doing.asks_on, question);
        const Part part = ask(inputs_, 0, on);
        for (std::size_t i = 0; i < questions.size(); ++i) answers[i] = part.answers[i * doing.asks_on];
    }

private:
    Inputs inputs_;
};

class Inner final : public LightOp {
public:
    void light(std::span<const Query> questions, std::span<Rgb> answers) const override {
        doing.asked_together.push_back(questions.size());
        std::fill(answers.begin(), answers.end(), Rgb{1, 2, 3});
    }
};

/// Asks about each pixel.
class AsksOnce final : public Renderer {
public:
    explicit AsksOnce(const NodeContext& here) : inputs_(here.inputs()) {}
    void render_block(const Tile& tile, std::span<Rgb> pixels) const override {
        const std::vector<Query> questions(tile.pixels());
        const Part part = ask(inputs_, 0, questions);
        for (std::size_t i = 0; i < questions.size(); ++i) pixels[2 * i + 1] += part.answers[i];
    }

private:
    Inputs inputs_;
};

Registry kinds() {
    return Registry({{.name = "Inner",
                      .help = "answers at once",
                      .make_light = [](const NodeContext&) { return std::make_unique<Inner>(); }},
                     {.name = "Dear",
                      .help = "takes its time",
                      .inputs = {0, 1},
                      .make_light = [](const NodeContext& here) { return std::make_unique<Dear>(here); }},
                     {.name = "AsksOnce",
                      .role = Role::image,
                      .help = "asks",
                      .inputs = {0, 1},
                      .make_renderer = [](const NodeContext& here) { return std::make_unique<AsksOnce>(here); }}});
}

Graph graph() {
    Graph graph;
    graph.file = "relief.lua";
    graph.nodes.push_back({"inner", "Inner", {}, {}, {}});
    graph.nodes.push_back({"dear", "Dear", {Value{NodeRef{"inner"}}}, {}, {}});
    graph.nodes.push_back({"image", "AsksOnce", {Value{NodeRef{"dear"}}}, {}, {}});
    return graph;
}

/// Asks for one tile after another until the time is over, and answers what the place gives away.
class Helper final : public Carrier {
public:
    /// How long the helper takes for so many questions, which it was asked as the `asked`-th bundle.
    using Takes = std::function<std::chrono::nanoseconds(std::size_t asked, std::size_t questions)>;
    Helper(Clock::duration runs_for, Takes takes, std::uint32_t side = 16)
        : ends_(Clock::now() + runs_for), takes_(std::move(takes)), side_(side) {}

    bool ask(const PlaceAt&, Message& message) override {
        const auto now = Clock::now();
        asked_at.push_back(now);
        const auto size = work_in(message);
        questions += size;
        free_ = std::max(free_, now) + takes_(asked_at.size(), size);
        auto reply = reply_to(message);
        reply.answers.assign(size, Rgb{1, 2, 3});
        answers_.push_back({free_, std::move(reply)});
        return true;
    }
    void reply(Message message) override {
        EXPECT_EQ(message.type, Message::Type::reply) << message.trouble.why;
        rendering_ = false;
    }
    std::optional<Message> receive() override {
        const auto now = Clock::now();
        if (!answers_.empty() && answers_.front().first <= now) {
            Message message = std::move(answers_.front().second);
            answers_.pop_front();
            return message;
        }
        if (rendering_ || ended_) return std::nullopt;
        Message message;
        message.run = 1;
        if (now >= ends_) {
            ended_ = true;
            message.type = Message::Type::stop;
            return message;
        }
        rendering_ = true;
        message.node = image, message.width = 2, message.bundle = ++tiles_;
        message.questions = std::make_shared<const std::vector<Tile>>(1, Tile{0, 0, side_, side_, 0, 1});
        return message;
    }
    void wait(std::chrono::nanoseconds most) override {
        std::this_thread::sleep_for(std::min<std::chrono::nanoseconds>(most, 200us));
    }
    void forget(const PlaceAt&) override {}
    const Counters& counters() const override { return none_; }
    std::uint64_t pulse(const std::string&) const override {
        return static_cast<std::uint64_t>(Clock::now().time_since_epoch() / 1ms);  // it works
    }

    std::size_t asked_since(Clock::time_point when) const {
        return static_cast<std::size_t>(
            std::count_if(asked_at.begin(), asked_at.end(), [&](auto at) { return at >= when; }));
    }
    Clock::time_point end() const { return ends_; }

    std::vector<Clock::time_point> asked_at;  // bundles
    std::size_t questions = 0;

private:
    Clock::time_point ends_, free_{};
    Takes takes_;
    std::uint32_t side_;  // pixels
    std::deque<std::pair<Clock::time_point, Message>> answers_;
    bool rendering_ = false, ended_ = false;
    std::uint64_t tiles_ = 0;
    Counters none_;
};

/// The place that renders holds all nodes; the helper `helped` alone.
Counters render(Helper& helper, const std::vector<std::uint32_t>& helped) {
    const Registry registry = kinds();
    const Network network{graph(), registry, std::make_shared<const Scene>(test::furnace(0.5f, 1)), 1};
    Plan plan{{{"a", 0}, {"b", 0}}, {{0}, {0}, {0}}};
    for (const auto node : helped) plan.places_of[node].push_back(1);
    Gauge gauge(network.graph.nodes.size(), asking_edges(network.graph, network.layers, registry).size());
    std::atomic<bool> stop{false};
    std::atomic<std::uint64_t> progress{0};
    Place place(network, plan.places[0], plan, 1, {}, helper, gauge);
    place.serve(stop, progress);
    return place.counters();
}

class PlaceRelief : public ::testing::Test {
protected:
    void SetUp() override { doing = {}; }
};

// A host that was stopped for a moment, or busy otherwise, is not out of it for the rest of the run.
TEST_F(PlaceRelief, AsksAHelperAgainThatWasSlowForAWhile) {
    doing.cost = 50us;
    Helper helper(9s, [](std::size_t asked, std::size_t size) -> std::chrono::nanoseconds {
        return asked <= 4 ? 400ms : size * 20us;
    });
    render(helper, {dear});
    EXPECT_GT(helper.asked_since(helper.end() - 1s), 10u) << "of " << helper.asked_at.size() << " bundles";
}

// Questions of which one takes longer than a bundle should: others are as good at them.
TEST_F(PlaceRelief, GivesQuestionsAwayThatTakeLong) {
    doing.cost = 25ms;
    Helper helper(
        3s, [](std::size_t, std::size_t size) -> std::chrono::nanoseconds { return size * 25ms; }, 4);
    render(helper, {dear});
    EXPECT_GT(helper.questions, doing.pieces.size() / 2) << "the helper is as fast as this place";
}

// What it asks on itself would be asked one by one otherwise, so that nobody could take it off this place.
TEST_F(PlaceRelief, AnswersDearQuestionsThatAskOnTogether) {
    doing.cost = 1ms, doing.asks_on = 2;
    Helper helper(2s, [](std::size_t, std::size_t size) -> std::chrono::nanoseconds { return size * 2ms; });
    render(helper, {dear});
    std::size_t all = 0, together = 0;
    for (const auto questions : doing.asked_together) {
        all += questions;
        if (questions >= RoutingPort::worth_sharing) together += questions;
    }
    ASSERT_GT(all, 0u);
    EXPECT_GT(2 * together, all) << "of " << all << " questions";
}

TEST_F(PlaceRelief, TellsWhatItAnswersItselfTakes) {
    doing.cost = 50us;
    Helper helper(1s, [](std::size_t, std::size_t size) -> std::chrono::nanoseconds { return size * 50us; });
    const auto counters = render(helper, {dear});
    std::size_t own = 0;
    for (const auto size : doing.pieces) own += size;
    ASSERT_GT(own, 1000u);
    ASSERT_GT(helper.questions, 0u) << "else nothing is shared";
    ASSERT_EQ(counters.places.size(), 1u);
    const auto& record = counters.places.front();
    ASSERT_TRUE(record.nodes.contains("dear"));
    EXPECT_GE(2 * record.nodes.at("dear").busy_ns, own * 50'000u) << "but for what others had of the processor";
    EXPECT_LE(record.nodes.at("dear").busy_ns, record.lived_ns);
}

}  // namespace
}  // namespace lightnet::place_relief_test
