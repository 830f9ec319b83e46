// A picture that grows, as the viewer tev is shown it.
#include "tools/preview/tev_preview.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <optional>

#include "core/base/error.hpp"
#include "tests/watch/tev_viewer.hpp"

namespace lightnet::tev_preview_test {
namespace {

using namespace std::chrono_literals;
using test::TevViewer;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

class TevPreviewTest : public ::testing::Test {
protected:
    TevPreview::Options options(std::uint16_t port) const { return {"127.0.0.1", port, "box.exr", format}; }
    void show(float value) {
        const Tile whole{0, 0, 40, 36};
        std::vector<Rgb> pixels;
        for (std::size_t i = 0; i < whole.pixels(); ++i)
            pixels.insert(pixels.end(), {{value, 2, float(i)}, {0, value, 1}, {7, 8, 9}});
        while (!board.show(whole, pixels)) std::this_thread::sleep_for(1ms);
    }
    static bool shows(const TevViewer::Seen& seen, float value) {
        const auto image = seen.images.find("box.exr");
        return image != seen.images.end() && image->second.channels.at("direct.R").back() == value;
    }

    // What a viewer has when it has this.
    TevViewer::Seen seen_of(float value) {
        TevViewer viewer;
        TevPreview preview(options(viewer.port()), board);
        show(value);
        EXPECT_TRUE(viewer.wait_for([&](const auto& seen) { return shows(seen, value); }));
        EXPECT_THAT(viewer.seen().errors, IsEmpty());
        return viewer.seen();
    }

    FilmFormat format{40, 36, {"direct", "bounce"}, 16, {}, {}, {{2, 1, 1}, {1, 0.5f, 1}}, {"depth"}, {}};
    WatchBoard board{{0, 0, 40, 36}, 3};
};

TEST_F(TevPreviewTest, HasABeautyAndALayerForEachColour) {
    const auto seen = seen_of(3);
    const auto& image = seen.images.at("box.exr");
    EXPECT_EQ(image.width, 40);
    EXPECT_EQ(image.height, 36);
    EXPECT_EQ(image.channels.size(), 12u);
    const auto last = [&](const std::string& channel) { return image.channels.at(channel).back(); };
    EXPECT_EQ(last("direct.B"), 40 * 36 - 1);
    EXPECT_EQ(last("bounce.G"), 3);
    EXPECT_EQ(last("depth.B"), 9);
    EXPECT_EQ(last("R"), 2 * 3 + 0) << "the layers, each times its gain";
    EXPECT_EQ(last("G"), 2 + 0.5f * 3);
}

TEST_F(TevPreviewTest, HasOneLayerForTheIdsOfAMatte) {
    format.shown = {"mattes"};
    format.facts = {"mattes"};
    format.ids = {{"mattes", 4}};
    const auto seen = seen_of(3);
    const auto& image = seen.images.at("box.exr");
    EXPECT_EQ(image.channels.size(), 12u);
    EXPECT_EQ(image.channels.at("mattes.B").back(), 9);
}

TEST_F(TevPreviewTest, ShowsAllToAViewerThatComesLaterOrAgain) {
    std::optional<TevViewer> viewer(std::in_place);
    const auto port = viewer->port();
    viewer.reset();
    TevPreview preview(options(port), board);
    show(1);
    viewer.emplace(port);
    EXPECT_TRUE(viewer->wait_for([](const auto& seen) { return shows(seen, 1); }));
    viewer.reset();
    show(2);
    viewer.emplace(port);
    EXPECT_TRUE(viewer->wait_for([](const auto& seen) { return shows(seen, 2); }));
    std::string said;
    for (const auto& line : preview.news()) said += line + "\n";
    EXPECT_THAT(said, HasSubstr("shows the picture"));
    EXPECT_THAT(said, HasSubstr("has gone; it is called again"));
}

TEST_F(TevPreviewTest, SendsWhatIsLeftAndThenTheFile) {
    TevViewer viewer;
    {
        TevPreview preview(options(viewer.port()), board);
        ASSERT_TRUE(viewer.wait_for([](const auto& seen) { return !seen.images.empty(); }));
        show(5);
        preview.finish("/pictures/box.exr");
    }
    ASSERT_TRUE(viewer.wait_for([](const auto& seen) { return !seen.opened.empty(); }));
    const auto seen = viewer.seen();
    EXPECT_THAT(seen.opened, ElementsAre("/pictures/box.exr"));
    EXPECT_THAT(seen.images, IsEmpty()) << "the file stands in its place";
    EXPECT_GT(seen.updates, 0);
    EXPECT_THAT(seen.errors, IsEmpty());
}

TEST_F(TevPreviewTest, TakesNoTimeWhereNobodyListens) {
    const auto begun = std::chrono::steady_clock::now();
    {
        std::optional<TevViewer> viewer(std::in_place);
        const auto port = viewer->port();
        viewer.reset();
        TevPreview preview(options(port), board);
        show(1);
    }
    EXPECT_LT(std::chrono::steady_clock::now() - begun, test::slowdown * 5s);
}

TEST_F(TevPreviewTest, WantsAHostThatThereIs) {
    EXPECT_THROW(TevPreview({"no-such-host.invalid", 14158, "x", format}, board), Error);
}

}  // namespace
}  // namespace lightnet::tev_preview_test
