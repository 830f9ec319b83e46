#include "core/run/prepare/lock_desk.hpp"

#include <gmock/gmock.h>

#include <cstring>

namespace lightnet::lock_desk_test {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::Pair;

const LockDesk::PlaceKey first{"a", 0}, second{"b", 0}, third{"b", 1};
const Hash device = content_hash(std::string_view("device")), licence = content_hash(std::string_view("licence"));
constexpr auto want = LockWord::Kind::want, release = LockWord::Kind::release, hold = LockWord::Kind::hold;

TEST(LockDesk, GivesALockToOneAfterTheOther) {
    LockDesk desk;
    for (const auto& place : {first, second, third}) desk.hear(place, {want, device});
    desk.hear(second, {want, licence});
    EXPECT_THAT(desk.granted(), ElementsAre(Pair(first, device), Pair(second, licence)));
    EXPECT_THAT(desk.granted(), IsEmpty());
    desk.hear(first, {release, device});
    EXPECT_THAT(desk.granted(), ElementsAre(Pair(second, device)));
}

TEST(LockDesk, TakesNoReleaseFromOneWhoDoesNotHoldIt) {
    LockDesk desk;
    desk.hear(first, {want, device});
    desk.hear(second, {want, device});
    desk.granted();
    desk.hear(second, {release, device});
    desk.hear(second, {release, licence});
    EXPECT_THAT(desk.granted(), IsEmpty());
}

TEST(LockDesk, FreesWhatALostPlaceHeldAndForgetsWhatItWanted) {
    LockDesk desk;
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

TEST(LockDesk, BelievesAPlaceThatWasOutOfSightWhatItHolds) {
    LockDesk desk;
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

TEST(LockDesk, DoesNotTakeALockFromWhoGotItMeanwhile) {
    LockDesk desk;
    desk.hear(second, {want, device});
    desk.granted();
    desk.hear(first, {hold, device});
    desk.hear(first, {release, device});
    desk.hear(third, {want, device});
    EXPECT_THAT(desk.granted(), IsEmpty());
}

Message step(Step::Kind kind, std::uint32_t call = 0) {
    Message ask;
    ask.questions = std::make_shared<const std::vector<Step>>(1, Step{.kind = kind, .call = call, .data = device});
    return ask;
}

TEST(PlaceLocks, TellAllAnewWhenTheLauncherHadLostSightOfThem) {
    Fibers fibers;
    std::vector<std::vector<LockWord>> said;
    PlaceLocks locks(
        fibers, [&](Fibers::Fiber* fiber) { fibers.resume(fiber); },
        [&](const Message& reply) {
            said.emplace_back(reply.data->size() / sizeof(LockWord));
            if (!reply.data->empty()) std::memcpy(said.back().data(), reply.data->data(), reply.data->size());
        });
    const auto hold_it = [&] {
        const auto held = locks.hold("device");
        fibers.park();
    };
    locks.take(step(Step::Kind::attend, 1));
    fibers.start("one", hold_it);
    locks.take(step(Step::Kind::attend));
    fibers.start("two", hold_it);
    locks.take(step(Step::Kind::grant));
    EXPECT_THAT(said, ElementsAre(ElementsAre(LockWord{want, device}), ElementsAre(LockWord{want, device}), IsEmpty()));
    locks.take(step(Step::Kind::attend, 1));
    EXPECT_THAT(said.back(), ElementsAre(LockWord{hold, device}, LockWord{want, device}));
    fibers.cancel_all();
}

}  // namespace
}  // namespace lightnet::lock_desk_test
