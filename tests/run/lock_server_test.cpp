#include "core/run/master/lock_server.hpp"

#include <gmock/gmock.h>

#include "core/run/master/lock_client.hpp"
#include "core/run/place/place_locks.hpp"

namespace lightnet::lock_server_test {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::Pair;

const PlaceAt first{"a", 0}, second{"b", 0}, third{"b", 1};
const Hash device = content_hash(std::string_view("device")), licence = content_hash(std::string_view("licence"));
constexpr auto want = LockMessage::Kind::want, release = LockMessage::Kind::release, hold = LockMessage::Kind::hold;

TEST(LockServer, GivesALockToOneAfterTheOther) {
    LockServer desk;
    for (const auto& place : {first, second, third}) desk.hear(place, {want, device});
    desk.hear(second, {want, licence});
    EXPECT_THAT(desk.granted(), ElementsAre(Pair(first, device), Pair(second, licence)));
    EXPECT_THAT(desk.granted(), IsEmpty());
    desk.hear(first, {release, device});
    EXPECT_THAT(desk.granted(), ElementsAre(Pair(second, device)));
}

TEST(LockServer, TakesNoReleaseFromOneWhoDoesNotHoldIt) {
    LockServer desk;
    desk.hear(first, {want, device});
    desk.hear(second, {want, device});
    desk.granted();
    desk.hear(second, {release, device});
    desk.hear(second, {release, licence});
    EXPECT_THAT(desk.granted(), IsEmpty());
}

TEST(LockServer, FreesWhatALostPlaceHeldAndForgetsWhatItWanted) {
    LockServer desk;
    desk.hear(first, {want, device});
    desk.hear(second, {want, device});
    desk.hear(third, {want, device});
    desk.granted();
    desk.lose(second);
    EXPECT_THAT(desk.granted(), IsEmpty());
    desk.lose(first);
    EXPECT_THAT(desk.granted(), ElementsAre(Pair(third, device)));
    desk.lose(third);
    desk.hear(first, {want, device});
    EXPECT_THAT(desk.granted(), ElementsAre(Pair(first, device)));
}

TEST(LockServer, BelievesAPlaceThatWasOutOfSightWhatItHolds) {
    LockServer desk;
    desk.hear(first, {want, device});
    desk.granted();
    desk.lose(first);
    desk.hear(first, {hold, device});
    desk.hear(first, {want, device});
    desk.hear(second, {want, device});
    EXPECT_THAT(desk.granted(), IsEmpty());
    desk.hear(first, {release, device});
    EXPECT_THAT(desk.granted(), ElementsAre(Pair(first, device))) << "another call there waits, too";
    desk.hear(first, {release, device});
    EXPECT_THAT(desk.granted(), ElementsAre(Pair(second, device)));
}

TEST(LockServer, DoesNotTakeALockFromWhoGotItMeanwhile) {
    LockServer desk;
    desk.hear(second, {want, device});
    desk.granted();
    desk.hear(first, {hold, device});
    desk.hear(first, {release, device});
    desk.hear(third, {want, device});
    EXPECT_THAT(desk.granted(), IsEmpty());
}

// What a keeper sends: to whom, and which step.
class LockKeeperTest : public testing::Test {
protected:
    using Sent = std::pair<PlaceAt, Step::Kind>;
    std::vector<Sent> attend(const std::vector<PlaceAt>& places) {
        sent.clear();
        keeper.attend(places);
        return sent;
    }
    void want_at(const PlaceAt& place) { keeper.hear(place, bytes_of(std::vector<LockMessage>{{want, device}})); }

    std::vector<Sent> sent;
    bool open = true;
    LockClient keeper{[this](const PlaceAt& place, const Step& step) {
        if (open) sent.emplace_back(place, step.kind);
        return open;
    }};
};

TEST_F(LockKeeperTest, KeepsOneStepAtEveryPlace) {
    EXPECT_THAT(attend({first, second}),
                ElementsAre(Pair(first, Step::Kind::attend), Pair(second, Step::Kind::attend)));
    EXPECT_THAT(attend({first, second}), IsEmpty());
    keeper.hear(first, nullptr);
    EXPECT_THAT(attend({first, second}), ElementsAre(Pair(first, Step::Kind::attend)));
}

TEST_F(LockKeeperTest, PassesALockOnUntilItCanBeSent) {
    attend({first});
    want_at(first);
    open = false;
    EXPECT_THAT(attend({first}), IsEmpty());
    open = true;
    EXPECT_THAT(attend({first}), ElementsAre(Pair(first, Step::Kind::attend), Pair(first, Step::Kind::grant)));
    EXPECT_THAT(attend({first}), IsEmpty());
}

TEST_F(LockKeeperTest, GivesTheLockOfALostPlaceToTheNext) {
    attend({first, second});
    want_at(first), want_at(second);
    attend({first, second});
    keeper.lose(first);
    EXPECT_THAT(attend({second}), ElementsAre(Pair(second, Step::Kind::grant)));
}

Message step(Step::Kind kind, std::uint32_t call = 0) {
    Message ask;
    ask.questions = std::make_shared<const std::vector<Step>>(1, Step{.kind = kind, .call = call, .data = device});
    return ask;
}

TEST(PlaceLocks, TellAllAnewWhenTheLauncherHadLostSightOfThem) {
    Fibers fibers;
    std::vector<std::vector<LockMessage>> said;
    PlaceLocks locks(
        fibers, [&](Fibers::Fiber* fiber) { fibers.resume(fiber); },
        [&](const Message& reply) { said.push_back(values_of<LockMessage>(reply.data)); });
    const auto hold_it = [&] {
        const auto held = locks.hold("device");
        fibers.park();
    };
    locks.take(step(Step::Kind::attend, 1));
    fibers.start("one", hold_it);
    locks.take(step(Step::Kind::attend));
    fibers.start("two", hold_it);
    locks.take(step(Step::Kind::grant));
    EXPECT_THAT(said,
                ElementsAre(ElementsAre(LockMessage{want, device}), ElementsAre(LockMessage{want, device}), IsEmpty()));
    locks.take(step(Step::Kind::attend, 1));
    EXPECT_THAT(said.back(), ElementsAre(LockMessage{hold, device}, LockMessage{want, device}));
    fibers.cancel_all();
}

}  // namespace
}  // namespace lightnet::lock_server_test
