// Many workers, and those that Slurm starts, loses and forgets.
#include <fmt/format.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>

#include "tests/faults/faults.hpp"
#include "tests/run/simulator.hpp"

namespace lightnet::test {
namespace {

// One invented run with so many places; each tile comes once.
double simulate(std::uint32_t hosts, std::uint32_t places, std::size_t tiles) {
    World world{.seed = 21, .twice = 0.1, .deaths = 1e-5};
    world.hosts = hosts, world.places_per_host = places, world.tiles = tiles;
    world.remember = false;
    world.most_events = 40 * tiles;
    const auto begun = Clock::now();
    const auto told = play(world);
    EXPECT_EQ(told.folded.size() + told.set_aside.size(), tiles);
    for (const auto& [tile, blocks] : told.folded) EXPECT_EQ(blocks, world.blocks) << "tile " << tile;
    EXPECT_EQ(told.outstanding, 0u);
    return seconds_since(begun);
}

TEST_F(Faults, OfACrowdOfWorkersAreNone) {
    reference(usual);
    constexpr int workers = 48;
    auto begun = Clock::now();
    expect_same(*start(usual, {"--local-workers", std::to_string(workers)}), usual);
    const double crowd = seconds_since(begun);
    expect_same(*start(usual, {"--threads", "600"}), usual);
    const Daemon wide(folder), other(folder);
    expect_same(
        *start(usual, {"--hosts", hosts_file({"'" + wide.endpoint + "' { places = 600 }", whole(other.endpoint)})}),
        usual);
    constexpr std::uint32_t hosts = 2500, places = 4;
    const double simulated = simulate(hosts, places, 50'000);
    done(fmt::format("{} local workers, 600 threads, a host of 600 places; {} simulated workers", workers,
                     hosts * places));
    seen(fmt::format("{:.0f} s with {} workers; 50,000 simulated tiles, each once, in {:.0f} s", crowd, workers,
                     simulated));
    figure("simulated", simulated, "s", 60, false);
}

// A Slurm of its own on loopback; see slurm_lab.sh.
class SlurmLab {
public:
    SlurmLab() {
        Process up({script(), "up", lab_.path().string(), "2"});
        there_ = up.wait(seconds(60)) == 0;
        words_ = up.output();
        ::setenv("SLURM_CONF", lab_.file("slurm.conf").c_str(), 1);
    }
    ~SlurmLab() { Process({script(), "down", lab_.path().string()}).wait(seconds(30)); }
    bool there() const { return there_; }
    const std::string& words() const { return words_; }
    void does(const std::string& what, const std::string& node = "") const {
        Process process({script(), what, lab_.path().string(), node});
        EXPECT_EQ(process.wait(seconds(20)), 0) << process.output();
    }
    void kill_controller() const {
        int id = 0;
        std::ifstream(lab_ / "run/slurmctld.pid") >> id;
        ASSERT_GT(id, 0);
        EXPECT_EQ(::kill(id, SIGKILL), 0);
    }

private:
    static std::string script() { return LIGHTNET_SOURCE_DIR "/tests/modes/slurm_lab.sh"; }
    Folder lab_;
    bool there_ = false;
    std::string words_;
};

bool no_jobs_within(seconds most) {
    for (const auto begun = Clock::now(); Clock::now() - begun < most; std::this_thread::sleep_for(milliseconds(200))) {
        Process queue({"/usr/bin/squeue", "--noheader", "--states=all", "--format=%T"});
        if (queue.wait(seconds(10)) == 0 && queue.output().find("RUNNING") == std::string::npos &&
            queue.output().find("PENDING") == std::string::npos)
            return true;
    }
    return false;
}

TEST_F(Faults, OfSlurmsNodesAndControllerChangeNoByte) {
    const SlurmLab lab;
    if (!lab.there()) NOT_RUN("no Slurm can be started here: " + lab.words().substr(0, lab.words().find('\n')));
    const auto on_slurm = [&](const std::string& daemons) {
        return start(lasting, {"--slurm", daemons, "--partition=main", "--slurm-args", "--output=/dev/null"});
    };
    auto run = on_slurm("2");
    EXPECT_TRUE(run->wait_for("-2 is ready", seconds(30)) && run->wait_for("\"event\":\"progress\"")) << run->output();
    lab.does("lose", "s2");
    EXPECT_TRUE(run->wait_for("is lost", seconds(30))) << run->output();
    expect_same(*run, lasting);

    run = on_slurm("4");
    EXPECT_TRUE(run->wait_for("is ready", seconds(60)) && run->wait_for("\"event\":\"progress\"")) << run->output();
    const auto ready = times(run->output(), "is ready");
    const auto begun = Clock::now();
    lab.does("node", "s3");
    while (times(run->output(), "is ready") == ready && seconds_since(begun) < 60 && pause(*run, milliseconds(20))) {
    }
    EXPECT_GT(times(run->output(), "is ready"), ready) << "the new node got no work\n" << run->output();
    const double grown = seconds_since(begun);
    lab.kill_controller();
    EXPECT_TRUE(pause(*run, seconds(2))) << "the run should go on without a controller\n" << run->output();
    lab.does("controller");
    expect_same(*run, lasting);
    EXPECT_TRUE(no_jobs_within(seconds(30))) << "Slurm still has jobs of the run";
    done("a node lost, a node more, the controller killed and started anew, in two runs");
    seen(fmt::format("the new node had work {:.1f} s after it came", grown));
    figure("grown", grown, "s", 5, false);
}

}  // namespace
}  // namespace lightnet::test
