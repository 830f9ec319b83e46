#include "core/runtime/lock_desk.hpp"

#include <gmock/gmock.h>

namespace lightnet {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::Pair;

const LockDesk::PlaceKey first{"a", 0}, second{"b", 0}, third{"b", 1};
const Hash device = content_hash(std::string_view("device")), licence = content_hash(std::string_view("licence"));
constexpr auto want = LockWord::Kind::want, release = LockWord::Kind::release;

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

}  // namespace
}  // namespace lightnet
