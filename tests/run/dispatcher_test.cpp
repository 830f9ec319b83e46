#include "core/run/place/dispatcher.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <deque>
#include <map>

#include "core/run/message/place_name.hpp"

namespace lightnet::dispatcher_test {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

constexpr std::uint32_t light = 0, image = 1;

/// Of the host: what the dispatcher asks of places, and replies.
class HostCarrier final : public Carrier {
public:
    bool ask(const PlaceAt& to, Message& message) override {
        EXPECT_EQ(to.host, "own");
        asked.push_back({to.index, std::move(message)});
        return true;
    }
    void reply(Message message) override { replies.push_back(std::move(message)); }
    std::optional<Message> receive() override {
        if (arrived.empty()) return std::nullopt;
        auto message = std::move(arrived.front());
        arrived.pop_front();
        return message;
    }
    void wait(std::chrono::nanoseconds) override {}
    void forget(const PlaceAt&) override {}
    const Counters& counters() const override { return none; }

    std::deque<Message> arrived;
    std::vector<std::pair<std::uint32_t, Message>> asked;  // place, and what
    std::vector<Message> replies;
    Counters none;
};

class DispatcherTest : public ::testing::Test {
protected:
    // Three places of this host, of which the first two hold the light, and one of another.
    Plan plan() const {
        Plan plan;
        plan.places = {{"own", 0}, {"own", 1}, {"own", 2}, {"other", 0}};
        plan.places_of = {{0, 1, 3}, {2}};
        return plan;
    }
    void tell(Plan plan) {
        Message message;
        message.type = Message::Type::plan;
        message.run = 7;
        message.plan = std::make_shared<const Plan>(std::move(plan));
        hear(std::move(message));
    }
    void ask(std::uint64_t number, std::size_t questions, const PlaceAt& asker = {"other", 0},
             const std::string& route = "way back", std::uint32_t edition = 0) {
        auto queries = std::make_shared<std::vector<Query>>(questions);
        for (std::size_t i = 0; i < questions; ++i) (*queries)[i].sample = static_cast<std::uint32_t>(i);
        Message message;
        message.run = 7;
        message.channel = 3;
        message.bundle = number;
        message.node = light;
        message.edition = edition;
        message.asker = name_of(asker);
        message.questions = std::move(queries);
        message.route.hops = {route};
        hear(std::move(message));
    }
    void hear(Message message) {
        carrier.arrived.push_back(std::move(message));
        dispatcher.step();
    }
    // The first place that was asked answers with the numbers of the samples.
    void answer(std::uint32_t service_ns = 1000) {
        auto [place, ask] = std::move(carrier.asked.front());
        carrier.asked.erase(carrier.asked.begin());
        Message reply = reply_to(ask);
        for (const auto& query : *std::get<Questions<Query>>(ask.questions))
            reply.answers.push_back({static_cast<float>(query.sample), 0, 0});
        reply.load = {0, service_ns};
        hear(std::move(reply));
    }
    std::vector<std::uint32_t> places_asked() const {
        std::vector<std::uint32_t> places;
        for (const auto& [place, message] : carrier.asked) places.push_back(place);
        return places;
    }

    double now = 0;
    HostCarrier carrier;
    Dispatcher dispatcher{"own", 7, 2, {}, carrier, [this] { return now; }};
};

TEST_F(DispatcherTest, DealsToThePlacesThatHoldTheNodeAndAnswersInTheirName) {
    tell(plan());
    ask(11, 3), ask(12, 4);
    EXPECT_THAT(places_asked(), testing::UnorderedElementsAre(0, 1));
    answer(), answer();
    ASSERT_EQ(carrier.replies.size(), 2u);
    const auto& reply = carrier.replies[0];
    EXPECT_EQ(reply.type, Message::Type::reply);
    EXPECT_EQ(reply.bundle, 11u) << "as the asker calls it";
    EXPECT_EQ(reply.channel, 3u);
    EXPECT_THAT(reply.route.hops, ElementsAre("way back"));
    EXPECT_EQ(reply.answers.size(), 3u);
    EXPECT_EQ(dispatcher.counters().dealt, 2u);
    EXPECT_EQ(dispatcher.counters().bundles, 0u) << "those who asked have counted them";
}

// A place that has let go of the node would be asked, and nobody answer.
TEST_F(DispatcherTest, KeepsWhatIsAskedByALaterPlanUntilItIsTold) {
    Plan first = plan(), second = plan();
    first.edition = 1, second.edition = 2;
    second.places_of[light] = {2};
    tell(first);
    ask(11, 3, {"other", 0}, "way back", 2);
    EXPECT_THAT(places_asked(), IsEmpty());
    tell(second);
    EXPECT_THAT(places_asked(), ElementsAre(2));
    EXPECT_EQ(carrier.asked[0].second.edition, 2u);
}

TEST_F(DispatcherTest, KeepsNoMoreOfALaterPlanThanHostsMayAsk) {
    AsksOfLaterPlans later;
    for (std::size_t i = 0; i <= AsksOfLaterPlans::most; ++i) {
        Message ask;
        ask.edition = 2;
        EXPECT_TRUE(later.keep(ask, 1)) << "it goes no further, kept or not";
    }
    EXPECT_EQ(later.due(2).size(), AsksOfLaterPlans::most);
}

TEST_F(DispatcherTest, TellsHowBusyItsPlacesAreTogether) {
    tell(plan());
    ask(1, 5), ask(2, 5), ask(3, 20);
    answer(1000);
    EXPECT_EQ(carrier.replies.at(0).load, (Load{25, 1000}));
}

TEST_F(DispatcherTest, CutsWhatIsLargeForItsIdlePlaces) {
    tell(plan());
    ask(1, 1), ask(2, 1);
    answer(100'000), answer(100'000);
    ask(3, 300);
    EXPECT_THAT(places_asked(), testing::UnorderedElementsAre(0, 1));
    answer(), answer();
    ASSERT_EQ(carrier.replies.size(), 3u);
    ASSERT_EQ(carrier.replies[2].answers.size(), 300u);
    for (std::size_t i = 0; i < 300; ++i) EXPECT_EQ(carrier.replies[2].answers[i].r, static_cast<float>(i));
}

TEST_F(DispatcherTest, WaitsForAPlanThatSaysWhoIsPrepared) {
    ask(1, 2);
    EXPECT_THAT(carrier.asked, IsEmpty());
    tell(plan());
    EXPECT_EQ(carrier.asked.size(), 1u);
}

TEST_F(DispatcherTest, HasThoseAnswerWhoHeldANodeThatHasMovedAway) {
    tell(plan());
    ask(1, 2);
    Plan later = plan();
    later.places_of[light] = {3};
    tell(later);
    ask(2, 2);
    EXPECT_EQ(carrier.asked.size(), 2u);
}

TEST_F(DispatcherTest, WaitsForItsOwnPlacesHoweverLongTheyTake) {
    tell(plan());
    ask(1, 2);
    for (now = 0; now < 10000; now += 1) dispatcher.step();
    EXPECT_EQ(carrier.asked.size(), 1u);
    answer();
    EXPECT_EQ(carrier.replies.size(), 1u);
}

TEST_F(DispatcherTest, AnswersOnceWhatIsSentAgainAndByTheLastWay) {
    tell(plan());
    ask(1, 2);
    ask(1, 2, {"other", 0}, "new way");
    EXPECT_EQ(carrier.asked.size(), 1u);
    answer();
    ASSERT_EQ(carrier.replies.size(), 1u);
    EXPECT_EQ(carrier.replies[0].route.hops, std::vector<std::string>{"new way"});
    ask(1, 2);
    EXPECT_EQ(carrier.asked.size(), 1u) << "the answer was lost";
}

TEST_F(DispatcherTest, PassesOnWhyAPlaceFailedAndWhereItHappened) {
    tell(plan());
    ask(1, 2);
    Message failure = reply_to(carrier.asked.at(0).second);
    failure.type = Message::Type::failure;
    failure.trouble = {"'bounce' on further: no photons", "further"};
    hear(failure);
    ASSERT_EQ(carrier.replies.size(), 1u) << "its other places would fail as well";
    EXPECT_EQ(carrier.replies[0].type, Message::Type::failure);
    EXPECT_EQ(carrier.replies[0].trouble, failure.trouble);
}

TEST_F(DispatcherTest, DropsWhatLostPlacesHadAsked) {
    Plan one = plan();
    one.places_of[light] = {0};
    tell(one);
    const std::uint64_t credit = Tuning().credit, asks = credit + 12;
    for (std::uint64_t i = 1; i <= asks; ++i) ask(i, 2);
    EXPECT_EQ(carrier.asked.size(), credit) << "credit of one place";
    one.places.pop_back();
    tell(one);
    EXPECT_EQ(dispatcher.counters().cancelled, asks);
    ask(asks + 1, 2, {"third", 0});
    for (std::uint64_t i = 0; i < credit; ++i) answer();
    EXPECT_THAT(carrier.replies, IsEmpty());
    ASSERT_EQ(carrier.asked.size(), 1u) << "credit came back";
    answer();
    EXPECT_EQ(carrier.replies.at(0).bundle, asks + 1);
}

TEST_F(DispatcherTest, DealsTilesAsItDealsQuestions) {
    tell(plan());
    ask(1, 2);
    Message message;
    message.run = 7;
    message.node = image;
    message.bundle = 5;
    message.questions = std::make_shared<const std::vector<Tile>>(1, Tile{0, 0, 2, 2, 0, 1});
    hear(message);
    ASSERT_EQ(carrier.asked.size(), 2u);
    EXPECT_EQ(carrier.asked[1].first, 2u);
    Message reply = reply_to(carrier.asked[1].second);
    reply.answers.resize(4);
    hear(reply);
    ASSERT_EQ(carrier.replies.size(), 1u);
    EXPECT_EQ(carrier.replies[0].bundle, 5u);
}

TEST_F(DispatcherTest, DropsWhatIsOfAnotherRunOrOfNoNode) {
    tell(plan());
    for (const auto& [run, node] : {std::pair(8u, light), {7u, 9u}}) {
        Message message;
        message.run = run;
        message.node = node;
        message.questions = std::make_shared<const std::vector<Query>>(1);
        hear(message);
    }
    ask(1, 0);
    EXPECT_THAT(carrier.asked, IsEmpty());
}

}  // namespace
}  // namespace lightnet::dispatcher_test
