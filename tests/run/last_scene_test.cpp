// A scene that waits for the next run.
#include "core/run/assembly/last_scene.hpp"

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

TEST(LastScene, IsLookedAtOtherwiseWhereNothingElseDiffers) {
    LastScene last;
    auto source = source_of("a");
    source.sight["camera"] = Value{1.0};
    const auto scene = std::make_shared<const Scene>(SceneData{});
    last.hold(source, scene);
    const auto other = std::make_shared<const Scene>(SceneData{});
    const auto look = [&](const Scene& built, bool edited) {
        EXPECT_EQ(&built, scene.get());
        EXPECT_FALSE(edited);
        return other;
    };
    source.sight["camera"] = Value{2.0};
    EXPECT_EQ(last.take(source, look), other);
    EXPECT_EQ(last.take(source, look), other) << "the first one stays";
    source.params["two_sided"] = Value{true};
    EXPECT_EQ(last.take(source, look), nullptr) << "it is another scene";
}

TEST(LastScene, IsEditedWhereNoMoreThanItsPartsDiffer) {
    LastScene last;
    auto source = source_of("a");
    last.hold(source, std::make_shared<const Scene>(SceneData{}));
    const auto other = std::make_shared<const Scene>(SceneData{});
    const auto edit = [&](const Scene&, bool edited) { return edited ? other : nullptr; };
    source.edits["lamps"] = Value{Table{}};
    source.sight["camera"] = Value{2.0};
    EXPECT_EQ(last.take(source, edit), other);
    source.params["two_sided"] = Value{true};
    EXPECT_EQ(last.take(source, edit), nullptr) << "it is another scene";
}

TEST(LastScene, StaysUntilTheNextOfTheSameFileIsThere) {
    LastScene last;
    auto source = source_of("a");
    const auto scene = std::make_shared<const Scene>(SceneData{});
    last.hold(source, scene);
    source.params["two_sided"] = Value{true};
    EXPECT_EQ(last.take(source), nullptr);
    EXPECT_EQ(scene.use_count(), 2) << "what the next has in common with it is still there";
    last.hold(source, std::make_shared<const Scene>(SceneData{}));
    EXPECT_EQ(scene.use_count(), 1);
}

TEST(LastScene, IsDroppedWhereMoreHangsOnTheCamera) {
    LastScene last;
    auto source = source_of("a");
    last.hold(source, std::make_shared<const Scene>(SceneData{}));
    source.sight["camera"] = Value{2.0};
    EXPECT_EQ(last.take(source, [](const Scene&, bool) { return nullptr; }), nullptr);
    EXPECT_EQ(last.take(source_of("a")), nullptr);
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
