// METG, the minimum effective task granularity (Slaughter et al. 2020, Task Bench): how much work a task has to be so
// that half of the time goes into the work, and half into handing it out.
//
// A task is a bundle of 256 questions to one place, eight under way; a question of such a bundle; or a tile, of which
// two places render one after the other. The work is emulated: whoever answers keeps its processor busy for so long.
// Its length is found by halving intervals. Plain ZeroMQ has the same work behind one DEALER and one ROUTER.
#include <cmath>
#include <cstdio>
#include <functional>
#include <string>
#include <vector>

#include "core/network/light/node_context.hpp"
#include "core/network/light/renderer.hpp"
#include "core/run/master/master_renderer.hpp"
#include "nodes/standard_nodes.hpp"
#include "tests/bench/asking.hpp"
#include "tests/bench/figure.hpp"
#include "tests/bench/picture.hpp"
#include "tests/bench/plain_pair.hpp"
#include "tests/bench/two_hosts.hpp"
#include "transport/launcher/threaded_run.hpp"

namespace lightnet::bench {
namespace {

using namespace std::chrono_literals;

constexpr double half = 0.5;
constexpr double shortest = 1e-7, longest = 4e-4;  // seconds of work that are tried
const int halvings = sized(7, 1);
const std::size_t tiles_of_each = sized<std::size_t>(2000, 20);

/// The least work of a task, in seconds, with which it is efficient; at most `longest` or so is tried. The task is so
/// many questions, or one, that whoever answers works on; `seconds_of_task` tells how long it takes in all.
double least_work(std::size_t questions, const std::function<double()>& seconds_of_task) {
    const auto efficient = [&](double work) {
        work_of_question() = work / double(questions);
        return work >= half * seconds_of_task();
    };
    double least = shortest, most = shortest;
    do least = most, most *= 8;
    while (!smoke() && most < longest && !efficient(most));
    for (int i = 0; i < halvings; ++i) {
        const double middle = std::sqrt(least * most);
        (efficient(middle) ? most : least) = middle;
    }
    work_of_question() = 0;
    return most;
}

// Without a goal: there is nothing to measure it by.
void report(const std::string& name, const std::function<double()>& measure) {
    std::vector<double> microseconds;
    for (int round = 0; round < repeated(3); ++round) microseconds.push_back(1e6 * measure());
    show((name + ", us of work per task").c_str(), microseconds);
}

void report_bundles(const std::string& way, const std::function<double()>& seconds_of_one) {
    std::vector<double> bundle, question;
    for (int round = 0; round < repeated(3); ++round) {
        bundle.push_back(1e6 * least_work(asked_together, seconds_of_one));
        question.push_back(bundle.back() / double(asked_together));
    }
    quantity("metg.bundle_" + way, bundle, "us of work per bundle of 256", 25, false);
    quantity("metg.question_" + way, question, "us of work per question", 0.4, false);
}

void measure_bundles(const Picture& picture) {
    const Registry kinds = asking_kinds();
    {
        const Job job = asking_job(picture);
        const Plan plan = one_asks_the_other({"", 0}, {"", 1});
        ThreadedRun run(build_network(job, kinds, LoadedScene{}), asking_run, plan, job.tuning);
        report_bundles("inproc", [&] { return seconds_of_bundle(run.carrier(), plan); });
        run.stop();
    }
    {
        TwoHosts hosts(kinds, picture, asking_run, asking_job(picture), one_asks_the_other);
        report_bundles("tcp", [&] { return seconds_of_bundle(hosts.cluster(), hosts.cluster().plan()); });
        hosts.cluster().finish();
    }
    PlainPair plain("tcp://127.0.0.1:*", PlainLoad::packets, asked_together);
    report("metg.bundle_plain",
           [&] { return least_work(asked_together, [&] { return seconds_of_plain_bundle(plain); }); });
}

/// Renders nothing, for as long as it is told to.
class Busy final : public Renderer {
public:
    void render_block(const Tile&, std::span<Rgb>) const override { work_on(1); }
};

Registry busy_kinds() {
    return Registry(
        {{.name = "Busy",
          .role = Role::image,
          .help = "renders nothing, for as long as it is told to",
          .params = {{.name = "scene", .type = ParamType::scene, .help = "what hosts read, and nobody asks"},
                     {.name = "film", .type = ParamType::film, .help = "which jobs have to have"}},
          .make_renderer = [](const NodeContext&) { return std::make_unique<Busy>(); }}});
}

Job busy_job(const Picture& picture) {
    return picture.of_nodes(
        "metg.lua", {{"busy",
                      "Busy",
                      {},
                      {{"scene", Value{NodeRef{"scene"}}}, {"film", Value{Table{{Value{1.0}, Value{1.0}}, {}}}}},
                      {}}});
}

Plan both_render(const PlaceAt& first, const PlaceAt& second) {
    Plan plan{{first, second}, std::vector<std::vector<std::uint32_t>>(2)};
    plan.places_of[0] = {0, 1};
    return plan;
}

// Of which each place has one at a time.
double seconds_of_tile(Carrier& carrier, const Plan& plan) {
    MasterRenderer::Job job;
    job.run = asking_run;
    job.image = 0;
    job.width = 1;
    job.tiles.resize(2 * tiles_of_each, Tile{0, 0, 1, 1, 0, 1});
    job.credit = {2, 2};
    return seconds_of([&] {
               MasterRenderer master(std::move(job), carrier, [](const Tile&, std::span<const Rgb>) {});
               master.use(plan);
               while (!master.work(50ms)) {
               }
           }) /
           double(tiles_of_each);
}

void measure_tiles(const Picture& picture) {
    const Registry kinds = busy_kinds();
    {
        const Job job = busy_job(picture);
        const Plan plan = both_render({"", 0}, {"", 1});
        ThreadedRun run(build_network(job, kinds, LoadedScene{}), asking_run, plan, job.tuning);
        report("metg.tile_inproc", [&] { return least_work(1, [&] { return seconds_of_tile(run.carrier(), plan); }); });
        run.stop();
    }
    TwoHosts hosts(kinds, picture, asking_run, busy_job(picture), both_render);
    report("metg.tile_tcp",
           [&] { return least_work(1, [&] { return seconds_of_tile(hosts.cluster(), hosts.cluster().plan()); }); });
    hosts.cluster().finish();
}

}  // namespace
}  // namespace lightnet::bench

int main() {
    namespace bench = lightnet::bench;
    return bench::run("metg", [] {
        const lightnet::Registry registry{lightnet::standard_nodes()};
        const bench::Picture picture(registry, 128, 16);
        bench::measure_bundles(picture);
        bench::measure_tiles(picture);
    });
}
