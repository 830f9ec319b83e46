// A scene that waits for the next run.
#include "transport/daemon/last_scene.hpp"

#include <gtest/gtest.h>

#include <memory>

namespace lightnet::last_scene_test {
namespace {

using std::chrono::minutes;

SceneSource source_of(const char* scene) {
    SceneSource source;
    source.scene = scene;
    return source;
}

TEST(LastScene, IsThereForTheSameSourceAlone) {
    LastScene last;
    EXPECT_EQ(last.take(source_of("a")), nullptr);
    const auto scene = std::make_shared<const Scene>(SceneData{});
    last.hold(source_of("a"), scene);
    EXPECT_EQ(last.take(source_of("a")), scene);
    EXPECT_EQ(last.take(source_of("b")), nullptr);
    EXPECT_EQ(last.take(source_of("a")), nullptr) << "there is room for the other one now";
    EXPECT_EQ(scene.use_count(), 1);
}

TEST(LastScene, IsDroppedWhenNoRunHasNeededItForFiveMinutes) {
    LastScene last;
    last.hold(source_of("a"), std::make_shared<const Scene>(SceneData{}));
    const LastScene::Time begin{};
    last.wait(begin);
    last.wait(begin + minutes(4));
    EXPECT_NE(last.take(source_of("a")), nullptr);  // a run, for however long
    last.wait(begin + minutes(60));
    last.wait(begin + minutes(64));
    EXPECT_NE(last.take(source_of("a")), nullptr);
    last.wait(begin + minutes(70));
    last.wait(begin + minutes(75));
    EXPECT_EQ(last.take(source_of("a")), nullptr);
}

}  // namespace
}  // namespace lightnet::last_scene_test
