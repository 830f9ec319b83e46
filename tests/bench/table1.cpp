// Table 1 of the paper: what bundling is worth. graphs/paper/table1.lua on the hosts of graphs/paper/hosts/table1.lua,
// the unchanged scalar classes of nodes/examples/candela: CandelaGathered, which asks its input about one spot after
// the other, on one host, and CandelaDirect on another, one millisecond away in each direction. Once every question
// travels alone and is waited for; once as the network does it by itself. One by one, a twentieth of the picture is
// rendered, and the time of the whole follows from it.
#include <atomic>
#include <chrono>
#include <cstdio>
#include <map>
#include <stdexcept>

#include "core/film/film.hpp"
#include "core/network/graph/check.hpp"
#include "core/network/graph/graph_film.hpp"
#include "core/readers/read_scene.hpp"
#include "core/run/assembly/fingerprint.hpp"
#include "core/run/assembly/job.hpp"
#include "core/run/master/master_renderer.hpp"
#include "core/run/message/credit.hpp"
#include "nodes/examples/candela/candela_kinds.hpp"
#include "nodes/standard_nodes.hpp"
#include "tests/bench/figure.hpp"
#include "tests/bench/paper.hpp"
#include "tests/support/delaying_proxy.hpp"
#include "tests/support/host_thread.hpp"
#include "transport/launcher/cluster.hpp"

namespace lightnet::bench {
namespace {

using namespace std::chrono_literals;

const std::uint32_t side = sized(76u, 20u);  // pixels; with 2 samples and 16 rays about 128,000 questions
constexpr std::uint32_t samples = 2;
const int rounds = repeated(3);

/// What one way of working took.
struct Cost {
    double seconds = 0, questions = 0, messages = 0, bytes = 0;
};

class Bench {
public:
    explicit Bench(const Registry& registry) : registry_(registry) {
        const auto size = std::to_string(side);
        job_.graph = check(paper_graph("table1", {{"width", size}, {"height", size}}), registry);
        job_.scene = scene_file(job_.graph, registry);
        job_.isa = usual_isa();
        job_.width = job_.height = side;
        DiskFiles disk;
        read_scene(disk, job_.scene);
        files_ = disk.seen();
        for (const auto& [path, bytes] : files_) job_.files.push_back({path, content_hash(*bytes), bytes->size()});
    }

    /// As the launcher does it.
    Cost bundled() {
        return measure(job_, tiles_of(side, side, job_.tuning.tile, samples), {2, 2 * MasterRenderer::most_together});
    }
    /// One question at a time, waited for; a twentieth of the picture's rows, spread over it.
    Cost one_by_one() {
        Job job = job_;
        job.tuning.bundle = 1;
        job.tuning.credit = job.tuning.credit_questions = 1;
        job.tuning.spare_fibers = job.tuning.side_fibers = 0;
        std::vector<Tile> tiles;
        for (std::uint32_t y = 10; y < side; y += 20) tiles.push_back({0, y, side, 1, 0, samples});
        return measure(job, tiles, {1, 1});
    }

private:
    Cost measure(const Job& job, const std::vector<Tile>& tiles, Credit under_way) {
        const test::HostThread near(registry_), far(registry_);
        const test::DelayingProxy line(far.endpoint(), 1ms);
        const Hosts hosts = paper_hosts("table1", {near.endpoint(), line.endpoint()});
        Cluster::Options options;
        options.run = 1;
        options.job = job;
        options.files = files_;
        options.endpoints = {near.endpoint(), line.endpoint()};
        options.plan = [&](const std::vector<HostOffer>& offers) { return plan(job.graph, registry_, hosts, offers); };
        Cluster cluster(std::move(options));
        const std::atomic<bool> never{false};
        cluster.gather(5s, never);
        cluster.adopt(cluster.plan());

        const auto before = line.bytes();
        Cost cost;
        cost.seconds = render(job, cluster, tiles, under_way);
        cost.bytes = static_cast<double>(line.bytes() - before);
        const Counters counters = cluster.finish(30s);  // on a machine that is busy hosts are late to tell
        cost.questions = static_cast<double>(counters.questions);
        cost.messages = static_cast<double>(counters.bundles);
        return cost;
    }

    double render(const Job& job, Cluster& cluster, const std::vector<Tile>& tiles, Credit under_way) {
        MasterRenderer::Job task;
        task.run = 1;
        task.image = static_cast<std::uint32_t>(*job.graph.find("image"));
        task.width = 2;  // emission, gathered
        task.tiles = tiles;
        task.credit = under_way;
        return seconds_of([&] {
            MasterRenderer master(std::move(task), cluster, [](const Tile&, std::span<const Rgb>) {});
            master.use(cluster.plan());
            while (!master.work(50ms)) {
            }
        });
    }

    const Registry& registry_;
    Job job_;
    std::map<std::string, Bytes> files_;
};

void show_cost(const char* name, const Cost& cost) {
    std::printf("  %s: %.0f questions in %.0f messages, %.2f s, %.1f bytes per question there and back\n", name,
                cost.questions, cost.messages, cost.seconds, cost.bytes / cost.questions);
    std::fflush(stdout);
}

void measure() {
    Registry registry{standard_nodes()};
    registry.add(candela_kinds());
    Bench bench(registry);
    const Cost slow = bench.one_by_one();
    show_cost("one by one, a part", slow);
    std::vector<double> times, messages, bytes;
    for (int round = 0; round < rounds; ++round) {
        const Cost fast = bench.bundled();
        show_cost("bundled", fast);
        times.push_back(fast.seconds / fast.questions / (slow.seconds / slow.questions));
        messages.push_back(fast.questions / fast.messages / (slow.questions / slow.messages));
        bytes.push_back(fast.bytes / fast.questions);
    }
    figure("table1.time", times, 0.005, false);
    quantity("table1.messages", messages, "times fewer", 600, true);
    quantity("table1.bytes", bytes, "bytes per question, answer included", 48, false);
}

}  // namespace
}  // namespace lightnet::bench

int main() {
    return lightnet::bench::run("table1", [&] { lightnet::bench::measure(); });
}
