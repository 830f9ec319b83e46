// A place, which is asked by the test.
#include "core/run/place/place.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <deque>
#include <memory>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "core/network/graph/check.hpp"
#include "core/network/light/services.hpp"
#include "nodes/standard_nodes.hpp"
#include "tests/support/small_scenes.hpp"

namespace lightnet::place_test {
namespace {

using namespace std::chrono_literals;

constexpr auto shard_takes = 200ms;
constexpr std::uint32_t slow = 1;  // in the graph

/// Its shards take long, its answers don't.
class SlowToPrepare final : public LightOp {
public:
    void prepare(Services& services) override {
        services.map<int>(1, [](std::size_t, std::vector<int>&) { std::this_thread::sleep_for(shard_takes); });
    }
    void light(std::span<const Query>, std::span<Rgb> answers) const override {
        std::fill(answers.begin(), answers.end(), Rgb{1, 1, 1});
    }
};

Registry kinds() {
    Kind kind{.name = "SlowToPrepare", .help = "takes long to prepare"};
    kind.run.prepares = true;
    kind.make_light = [](const NodeContext&) { return std::make_unique<SlowToPrepare>(); };
    auto all = standard_nodes();
    all.push_back(std::move(kind));
    return Registry(std::move(all));
}

Graph graph_of(const Registry& registry) {
    return check({"test.lua",
                  {{"scene", "Scene", {Value{std::string("none.pbrt")}}, {}, {"test.lua", 1}},
                   {"slow", "SlowToPrepare", {}, {}, {"test.lua", 2}},
                   {"image",
                    "RayTracer",
                    {Value{NodeRef{"slow"}}},
                    {{"scene", Value{NodeRef{"scene"}}}, {"film", Value{Table{{Value{8.0}, Value{8.0}}, {}}}}},
                    {"test.lua", 3}}}},
                 registry);
}

/// Asks one thing after another, each when the one before has been answered; then ends the run.
class OneByOne final : public Carrier {
public:
    bool ask(const PlaceAt&, Message&) override { return false; }
    void reply(Message message) override {
        replies.push_back(std::move(message));
        waits = false;
    }
    std::optional<Message> receive() override {
        if (waits) return std::nullopt;
        waits = true;
        Message message;
        message.type = Message::Type::stop;
        if (!asks.empty()) {
            message = std::move(asks.front());
            asks.pop_front();
        }
        message.run = 1;
        message.node = slow;
        return message;
    }
    void wait(std::chrono::nanoseconds) override {}
    void forget(const PlaceAt&) override {}
    const Counters& counters() const override { return none; }

    void add(Step step) {
        asks.emplace_back().questions = std::make_shared<const std::vector<Step>>(std::vector<Step>{step});
    }

    std::deque<Message> asks;
    std::vector<Message> replies;
    bool waits = false;
    Counters none;
};

/// Asks for a tile, tells of the plan in force some time later, and ends the run when that has led to a question.
class LateToTell final : public Carrier {
public:
    LateToTell(Plan plan, std::size_t width)
        : plan_(std::make_shared<const Plan>(std::move(plan))), width_(static_cast<std::uint32_t>(width)) {}
    bool ask(const PlaceAt&, Message&) override {
        ++(told ? asked : asked_too_soon);
        return true;
    }
    void reply(Message message) override {
        if (message.type == Message::Type::failure) why = message.trouble.why;
    }
    std::optional<Message> receive() override {
        Message message;
        message.run = 1;
        if (!std::exchange(asked_tile_, true)) {
            message.node = image;
            message.width = width_;
            message.questions = std::make_shared<const std::vector<Tile>>(1, Tile{0, 0, 8, 8, 0, 1});
            return message;
        }
        if (!told && waits_ > 3) {
            told = true;
            message.type = Message::Type::plan, message.plan = plan_;
            return message;
        }
        if ((asked + asked_too_soon == 0 && waits_ < 1000) || std::exchange(ended_, true)) return std::nullopt;
        message.type = Message::Type::stop;
        return message;
    }
    void wait(std::chrono::nanoseconds) override {
        ++waits_;
        std::this_thread::sleep_for(100us);
    }
    void forget(const PlaceAt&) override {}
    const Counters& counters() const override { return none_; }

    static constexpr std::uint32_t image = 2;
    bool told = false;
    int asked = 0, asked_too_soon = 0;
    std::string why;  // the tile failed

private:
    std::shared_ptr<const Plan> plan_;
    std::uint32_t width_;  // colours of a pixel
    bool asked_tile_ = false, ended_ = false;
    int waits_ = 0;
    Counters none_;
};

// The plan that it makes its nodes by may name places that are not prepared, and others may ask it before it has heard
// of the one in force: what it would be answered then was in no picture.
TEST(Place, AsksNobodyBeforeItIsToldWhomToAsk) {
    const Registry registry = kinds();
    const Graph graph = graph_of(registry);
    const Network network{graph, registry, std::make_shared<const Scene>(test::furnace(0.5f, 1), SceneOptions{}), 1};
    const Plan plan{{{"a", 0}, {"b", 0}}, {{}, {1}, {0}}};
    Gauge gauge(graph.nodes.size(), asking_edges(graph, network.layers, registry).size());
    LateToTell carrier(plan, colours_of(network.layers));
    std::atomic<bool> stop{false};
    std::atomic<std::uint64_t> progress{0};
    Place(network, plan.places[0], plan, 1, {}, carrier, gauge, Place::Asks::when_told).serve(stop, progress);
    EXPECT_EQ(carrier.asked_too_soon, 0);
    EXPECT_GT(carrier.asked, 0) << carrier.why;
}

/// Asks for a tile by the second plan before that has been told; says who is asked then.
class Overtaking final : public Carrier {
public:
    Overtaking(Plan first, Plan second, std::size_t width) : width_(static_cast<std::uint32_t>(width)) {
        first.edition = 1, second.edition = 2;
        tell(std::move(first));
        auto& tile = comes_.emplace_back();
        tile.node = 2, tile.width = width_, tile.edition = 2;
        tile.questions = std::make_shared<const std::vector<Tile>>(1, Tile{0, 0, 8, 8, 0, 1});
        for (int i = 0; i < 5; ++i) comes_.emplace_back();  // nothing
        tell(std::move(second));
    }
    bool ask(const PlaceAt& to, Message& message) override {
        asked.push_back(to.host + " by " + std::to_string(message.edition));
        return true;
    }
    void reply(Message) override {}
    std::optional<Message> receive() override {
        if (comes_.empty()) return ask_for_the_end();
        auto message = std::move(comes_.front());
        comes_.pop_front();
        message.run = 1;
        if (message.type == Message::Type::ask && message.edition == 0) return std::nullopt;
        return message;
    }
    void wait(std::chrono::nanoseconds) override { ++waits_; }
    void forget(const PlaceAt&) override {}
    const Counters& counters() const override { return none_; }

    std::vector<std::string> asked;

private:
    void tell(Plan plan) {
        auto& message = comes_.emplace_back();
        message.type = Message::Type::plan, message.plan = std::make_shared<const Plan>(std::move(plan));
    }
    std::optional<Message> ask_for_the_end() {
        if ((asked.empty() && waits_ < 1000) || std::exchange(ended_, true)) return std::nullopt;
        Message message;
        message.type = Message::Type::stop, message.run = 1;
        return message;
    }

    std::uint32_t width_;  // colours of a pixel
    std::deque<Message> comes_;
    bool ended_ = false;
    int waits_ = 0;
    Counters none_;
};

// An ask may come by another line than the plan that its asker goes by. By the plan before, the node would be asked
// where it has been taken away.
TEST(Place, AsksByNoOlderPlanThanWhoAsksIt) {
    const Registry registry = kinds();
    const Graph graph = graph_of(registry);
    const Network network{graph, registry, std::make_shared<const Scene>(test::furnace(0.5f, 1), SceneOptions{}), 1};
    const std::vector<PlaceAt> places{{"a", 0}, {"b", 0}, {"c", 0}};
    const Plan first{places, {{}, {1}, {0}}}, second{places, {{}, {2}, {0}}};
    Gauge gauge(graph.nodes.size(), asking_edges(graph, network.layers, registry).size());
    Overtaking carrier(first, second, colours_of(network.layers));
    std::atomic<bool> stop{false};
    std::atomic<std::uint64_t> progress{0};
    Place(network, places[0], first, 1, {}, carrier, gauge, Place::Asks::when_told).serve(stop, progress);
    ASSERT_FALSE(carrier.asked.empty());
    for (const auto& asked : carrier.asked) EXPECT_EQ(asked, "c by 2");
}

/// All comes at once; the run ends when all is answered.
class AllAtOnce final : public Carrier {
public:
    bool ask(const PlaceAt&, Message&) override { return false; }
    void reply(Message message) override { replies.push_back(std::move(message)); }
    std::optional<Message> receive() override {
        if (asks.empty() && (replies.size() < asked_ || std::exchange(ended_, true))) return std::nullopt;
        Message message;
        if (asks.empty()) {
            message.type = Message::Type::stop;
        } else {
            message = std::move(asks.front());
            asks.pop_front();
            message.node = slow, message.bundle = ++asked_;
        }
        message.run = 1;
        return message;
    }
    void wait(std::chrono::nanoseconds) override {}
    void forget(const PlaceAt&) override {}
    const Counters& counters() const override { return none_; }

    std::deque<Message> asks;
    std::vector<Message> replies;

private:
    std::size_t asked_ = 0;
    bool ended_ = false;
    Counters none_;
};

// A place that has much to do gets to some of it only when nobody may ask any more: with a failure, its host would be
// taken out of the run.
TEST(Place, AnswersWhatWasAskedBeforeItsNodeLeaves) {
    const Registry registry = kinds();
    const Graph graph = graph_of(registry);
    const Network network{graph, registry, std::make_shared<const Scene>(test::furnace(0.5f, 1), SceneOptions{}), 1};
    const Plan plan{{{"", 0}}, std::vector<std::vector<std::uint32_t>>(graph.nodes.size(), {0})};
    Gauge gauge(graph.nodes.size(), asking_edges(graph, network.layers, registry).size());
    AllAtOnce carrier;
    carrier.asks.emplace_back().questions = std::make_shared<const std::vector<Query>>(64);
    const auto step = [&](Step::Kind kind) {
        carrier.asks.emplace_back().questions = std::make_shared<const std::vector<Step>>(std::vector<Step>{{kind}});
    };
    step(Step::Kind::leave);
    step(Step::Kind::prepare);  // it comes back, and waits for its shards
    std::atomic<bool> stop{false};
    std::atomic<std::uint64_t> progress{0};
    Place(network, plan.places[0], plan, 1, {}, carrier, gauge).serve(stop, progress);
    ASSERT_EQ(carrier.replies.size(), 3u);
    EXPECT_EQ(carrier.replies[0].bundle, 1u);
    EXPECT_EQ(carrier.replies[0].answers, std::vector<Rgb>(64, Rgb{1, 1, 1})) << carrier.replies[0].trouble.why;
    EXPECT_EQ(carrier.replies[1].bundle, 2u);
    EXPECT_EQ(carrier.replies[2].bundle, 3u);
}

// A shard takes as long as thousands of questions: askers would think that these take as long.
TEST(Place, TellsHowLongAQuestionTakesWhateverShardsTook) {
    const Registry registry = kinds();
    const Graph graph = graph_of(registry);
    const Network network{graph, registry, std::make_shared<const Scene>(test::furnace(0.5f, 1), SceneOptions{}), 1};
    const Plan plan{{{"", 0}}, std::vector<std::vector<std::uint32_t>>(graph.nodes.size(), {0})};
    Gauge gauge(graph.nodes.size(), asking_edges(graph, network.layers, registry).size());
    OneByOne carrier;
    carrier.add({Step::Kind::prepare});
    carrier.add({Step::Kind::shards, 0, 0, 1});
    carrier.asks.emplace_back().questions = std::make_shared<const std::vector<Query>>(64);
    std::atomic<bool> stop{false};
    std::atomic<std::uint64_t> progress{0};
    Place(network, plan.places[0], plan, 1, {}, carrier, gauge).serve(stop, progress);
    ASSERT_EQ(carrier.replies.size(), 3u);
    const auto told = [&](std::size_t i) { return std::chrono::nanoseconds(carrier.replies[i].load.service_ns); };
    EXPECT_GE(told(1), shard_takes * 0.9);
    EXPECT_LT(told(2), shard_takes * 0.1);
    EXPECT_EQ(carrier.replies[2].answers, std::vector<Rgb>(64, Rgb{1, 1, 1}));
}

}  // namespace
}  // namespace lightnet::place_test
