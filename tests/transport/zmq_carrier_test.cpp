#include "transport/zmq_carrier.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <memory>
#include <thread>
#include <zmq.hpp>

#include "transport/sockets.hpp"

namespace lightnet::zmq_carrier_test {
namespace {

// At the end of a run a place may end before one that still asks it.
TEST(ZmqCarrier, CountsWhatAFullPlaceRefusesAndNotWhatOneDoesThatIsNotThere) {
    zmq::context_t context;
    ZmqCarrier asker(context, {.run = 1, .host = "me", .place = 0});
    const auto ask = [&] {
        Message message;
        message.run = 1;
        message.questions = std::make_shared<const std::vector<Query>>(1);
        return asker.ask({"me", 1}, message);
    };
    auto answerer = std::make_unique<ZmqCarrier>(context, ZmqCarrier::Ends{.run = 1, .host = "me", .place = 1});
    int sent = 0;
    while (ask()) ++sent;
    EXPECT_GE(sent, high_water_mark);
    EXPECT_EQ(asker.counters().refused_sends, 1u) << "it is full";

    while (auto asked = answerer->receive()) answerer->reply(reply_to(*asked));
    while (asker.receive()) --sent;
    EXPECT_EQ(sent, 0);
    answerer.reset();
    for (int turn = 0; ask(); ++turn) {  // its end takes a moment
        ASSERT_LT(turn, 1000);
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    EXPECT_EQ(asker.counters().refused_sends, 1u) << "nobody was there";
}

}  // namespace
}  // namespace lightnet::zmq_carrier_test
