// What a run says of itself.
#include "tools/session/run_recorder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>

#include "core/film/clean_layers.hpp"
#include "tests/support/folder.hpp"

namespace lightnet::run_recorder_test {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

TEST(RunRecorder, NamesTheNodeThatMadeWhatIsNotFinite) {
    Graph graph;
    graph.nodes = {{"direct", "DirectLighting", {}, {}, {}},
                   {"bounce", "PathTracing", {}, {}, {}},
                   {"light", "Combine", {{NodeRef{"direct"}}, {NodeRef{"bounce"}}}, {}, {}}};
    RunRecorder book({1, 1, {"emission"}, 1}, ProgressMode::none, 1, {});
    Counters counters;
    counters.not_finite = {{"bounce", 2}, {"light", 2}};
    book.account().count(counters);
    alert_of_bad_light(book.account(), graph);
    const test::Folder folder;
    book.write_report(folder / "x.exr", "done");
    std::ifstream file(folder / "x.run.json");
    const std::string json{std::istreambuf_iterator<char>(file), {}};
    EXPECT_THAT(json, testing::HasSubstr("PathTracing 'bounce' gave 2 answers that are not finite"));
    EXPECT_THAT(json, testing::Not(testing::HasSubstr("'light'")));
    EXPECT_THAT(json, testing::HasSubstr("\"not_finite.bounce\": 2"));
}

// What stands on standard error meanwhile.
std::string said_by(const std::function<void()>& act) {
    testing::internal::CaptureStderr();
    act();
    return testing::internal::GetCapturedStderr();
}

TEST(RunRecorder, IsHeardInEveryModeWhenSomethingIsLost) {
    for (const auto mode : {ProgressMode::none, ProgressMode::plain, ProgressMode::bar, ProgressMode::json}) {
        RunRecorder book({1, 1, {"emission"}, 1}, mode, 1, {});
        EXPECT_THAT(said_by([&] { book.account().alert("x.exr is elsewhere"); }),
                    HasSubstr("lightnet: x.exr is elsewhere"));
        EXPECT_THAT(said_by([&] { book.account().alert("x.exr is elsewhere"); }), IsEmpty()) << "once is enough";
        EXPECT_EQ(said_by([&] { book.account().warn("it takes longer"); }).empty(), mode == ProgressMode::none);
    }
}

TEST(RunRecorder, SaysInEveryModeThatItsPreviewOrCheckpointIsLost) {
    const test::Folder folder;
    const std::string nowhere = (folder / "none" / "x.exr").string();
    RunRecorder book({1, 1, {"emission"}, 16}, ProgressMode::none, 1, {});
    book.so_far().preview(nowhere, 1e6);
    EXPECT_THAT(said_by([&] { book.so_far().preview_now(nowhere); }), HasSubstr("no preview: "));
    book.keep_checkpoint(nowhere, {}, std::chrono::seconds(0));
    const std::vector<Rgb> pixels(1);
    const auto said = said_by([&] {
        book.take({0, 0, 1, 1, 0, 16}, pixels);
        book.end_checkpoint(true);
    });
    EXPECT_THAT(said, HasSubstr("samples can't be added to the picture later: "));
}

// Hosts that hear nothing for seconds take the run for gone.
TEST(RunRecorder, HasHostsAttendedToWhileItCleansOrWritesMuch) {
    constexpr std::uint32_t side = 512, least = 32;
    FilmFormat format{side, side, {"direct"}, 64, {}, {1e-6f, least}};
    format.shown = {cleaning::half_of("direct")};
    RunRecorder book(format, ProgressMode::none, side, {});
    int times = 0;
    book.files().attend_by([&] { ++times; });
    std::vector<Rgb> pixels(std::size_t{side} * side * format.colours());
    for (float value = 0; auto& pixel : pixels) pixel.r = value += 0.37f;  // what isn't packed in no time
    std::vector<Tile> next;
    for (std::uint32_t block = 0; block < least / samples_per_block; ++block)
        next = book.take({0, 0, side, side, block * samples_per_block, samples_per_block}, pixels);
    EXPECT_FALSE(next.empty()) << "a round is over";
    EXPECT_GT(times, 0);
    times = 0;
    const test::Folder folder;
    EXPECT_EQ(book.so_far().preview_now(folder / "x.exr"), "");
    EXPECT_GT(times, 0);
}

// The report beside a picture tells how that came about.
TEST(RunRecorder, LeavesAPictureItsReportWhereItHasWrittenNone) {
    const test::Folder folder;
    const std::string exr = folder / "x.exr";
    const auto text_of = [&](const std::string& name) {
        std::ifstream file(folder / name);
        return std::string(std::istreambuf_iterator<char>(file), {});
    };
    const auto end = [&](const std::string& outcome, bool picture) {
        RunRecorder book({1, 1, {"emission"}, 1}, ProgressMode::none, 1, {});
        if (picture) book.write_picture(exr);
        book.write_report(exr, outcome);
    };
    end("failed", false);
    EXPECT_THAT(text_of("x.run.json"), HasSubstr("failed")) << "there is no other";
    end("done", true);
    const auto report = text_of("x.run.json");
    for (const std::string outcome : {"failed", "cancelled"}) {
        end(outcome, false);
        EXPECT_EQ(text_of("x.run.json"), report);
        EXPECT_THAT(text_of("x.run.failed.json"), HasSubstr("\"outcome\": \"" + outcome + "\""));
    }
    end("cancelled", true);
    EXPECT_THAT(text_of("x.run.json"), HasSubstr("cancelled")) << "it is of the picture that is there";
    EXPECT_FALSE(std::filesystem::exists(folder / "x.run.failed.json"));
}

}  // namespace
}  // namespace lightnet::run_recorder_test
