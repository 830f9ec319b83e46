// Hosts that have what nodes have prepared, and are asked for it by one that comes late: lost, slow, and liars.
#include <fmt/format.h>

#include <functional>

#include "tests/faults/faults.hpp"
#include "tests/support/bad_line.hpp"
#include "tests/support/meddling_post.hpp"

namespace lightnet::test {
namespace {

// A map of photons: some 3 MB, which nobody sends along with a step.
std::string graph_with_a_map() {
    return "scene = Scene { '" + graph_file("glass_ball.pbrt") +
           "' }\n"
           "direct = DirectLighting {}\n"
           "caustics = PhotonMap { paths = 'caustic', photons = 400000, gather = 200 }\n"
           "light = Combine { direct, caustics }\n"
           "image = RayTracer { light, scene = scene, samples = 256, film = { 96, 96 } }\n";
}

/// A run on one host, to which another one comes when the first has prepared. Each has a cache of its own.
class LateComer {
public:
    LateComer(const Folder& folder, const std::string& graph, const std::string& holder)
        : out_(folder / "late.exr"), late_(own_), gate_(late_.endpoint) {
        gate_.hold(true);
        const auto hosts =
            folder.write("late.lua", "place " + whole(holder) + "\nplace " + whole(gate_.endpoint()) + "\n");
        run_ = std::make_unique<Process>(
            launch_words(graph, out_, {"--hosts", hosts, "--cache", "none", "--progress", "json"}));
        EXPECT_TRUE(run_->wait_for("\"event\":\"progress\"", slowdown * seconds(60))) << run_->output();
    }
    void come() { gate_.hold(false); }
    Process& run() { return *run_; }
    std::string said() {
        late_.process->wait_for("never said", milliseconds(200));  // else what is there is not read
        return late_.process->output();
    }
    /// Bytes that the launcher has sent, of files and results.
    double expect_same(const std::string& picture) {
        const auto end = finish(*run_, out_, slowdown * seconds(120));
        EXPECT_EQ(end.code, 0) << end.said;
        EXPECT_TRUE(end.picture == picture) << "the bytes differ\n" << end.said << said();
        EXPECT_NE(end.said.find(gate_.endpoint() + " is ready"), std::string::npos) << end.said << said();
        return end.code == 0 ? counter(end.report, "file_bytes") : 0;
    }

private:
    std::filesystem::path out_;
    Folder own_;
    Daemon late_;
    BadLine gate_;
    std::unique_ptr<Process> run_;
};

TEST_F(Faults, OfThoseWhoHaveResultsChangeNoByte) {
    const auto graph = folder.write("map.lua", graph_with_a_map());
    const auto peace = launch(graph, folder, {"--threads", "1", "--cache", "none"}, slowdown * seconds(120));
    ASSERT_EQ(peace.code, 0) << peace.said;
    const std::string asks_no_more = "for no results any more";

    const auto played = [&](const std::string& holder, const std::function<void(LateComer&)>& fault) {
        LateComer late(folder, graph, holder);
        fault(late);
        const double bytes = late.expect_same(peace.picture);
        return std::pair(bytes, late.said());
    };
    const auto comes = [](LateComer& late) { late.come(); };

    const Folder one, two, three, four;
    const Daemon sound(one);
    const auto [in_peace, said_in_peace] = played(sound.endpoint, comes);
    EXPECT_EQ(times(said_in_peace, asks_no_more), 0u) << said_in_peace;

    const Daemon lying(two);
    const MeddlingPost liar(lying.endpoint, {.lies = true});
    const auto [lied, said_of_liar] = played(liar.endpoint(), comes);
    EXPECT_GT(liar.meddled(), 0u);
    EXPECT_GT(times(said_of_liar, "what it gave is not what its hash says"), 0u) << said_of_liar;
    EXPECT_GT(lied, in_peace) << "the launcher has given what the liar did not";

    const Daemon narrow(three);
    BadLine line(narrow.endpoint);
    const auto [slow, said_of_slow] = played(line.endpoint(), [&](LateComer& late) {
        line.limit(100'000);
        late.come();
    });
    EXPECT_GT(times(said_of_slow, asks_no_more), 0u) << said_of_slow;
    EXPECT_GT(slow, in_peace);

    const Daemon leaving(four);
    BadLine cut(leaving.endpoint);
    const auto [lost, said_of_lost] = played(cut.endpoint(), [&](LateComer& late) {
        cut.limit(200'000);
        late.come();
        Faults::pause(late.run(), milliseconds(2000));
        leaving.process->signal(SIGKILL);
    });
    EXPECT_GT(lost, in_peace);

    done(
        fmt::format("a host that comes late asks one that lies ({} pieces changed), one behind 100 kB/s, and one that "
                    "is killed meanwhile",
                    liar.meddled()));
    seen(
        fmt::format("the launcher sent {:.1f} MB where all was sound, {:.1f}, {:.1f} and {:.1f} MB then; liar and slow "
                    "one were left",
                    in_peace / 1e6, lied / 1e6, slow / 1e6, lost / 1e6));
}

}  // namespace
}  // namespace lightnet::test
