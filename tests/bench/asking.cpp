#include "tests/bench/asking.hpp"

#include <atomic>
#include <chrono>
#include <cstdio>
#include <memory>
#include <thread>

#include "core/network/light/light_op.hpp"
#include "core/network/light/node_context.hpp"
#include "core/network/light/renderer.hpp"
#include "core/run/master/master_renderer.hpp"
#include "tests/bench/figure.hpp"

namespace lightnet::bench {
namespace {

using namespace std::chrono_literals;

constexpr std::size_t bundle = asked_together;
constexpr std::size_t in_flight = 8;
const std::size_t asks = sized<std::size_t>(8000, 200);  // bundles per measurement
const int rounds = repeated(9);

// ---- the full way ---------------------------------------------------------------------------------------------------

class Trivial final : public LightOp {
public:
    void light(std::span<const Query> questions, std::span<Rgb> answers) const override {
        for (std::size_t i = 0; i < questions.size(); ++i) answers[i] = answer_to(questions[i]);
    }
};

// A renderer that asks, bundle after bundle, whatever the tile is.
class Asker final : public Renderer {
public:
    explicit Asker(const NodeContext& here) : inputs_(here.inputs()), questions_(some_questions(bundle)) {}
    void render_block(const Tile&, std::span<Rgb>) const override {
        std::vector<Rgb> answers(bundle);
        for (std::size_t i = 0; i < asks / in_flight; ++i) {
            Port& port = *inputs_[0].port;
            port.finish(port.begin(questions_, answers));
        }
        expect_answers(questions_, answers);
    }

private:
    Inputs inputs_;
    std::vector<Query> questions_;
};

}  // namespace

Registry asking_kinds() {
    return Registry(
        {{.name = "Trivial",
          .help = "answers at once",
          .make_light = [](const NodeContext&) { return std::make_unique<Trivial>(); }},
         {.name = "Asker",
          .role = Role::image,
          .help = "asks",
          .inputs = {1, 1},
          .params = {{.name = "scene", .type = ParamType::scene, .help = "what hosts read, and nobody asks"},
                     {.name = "film", .type = ParamType::film, .help = "which jobs have to have"}},
          .make_renderer = [](const NodeContext& here) { return std::make_unique<Asker>(here); }}});
}

namespace {

constexpr std::size_t trivial = 0, asker = 1;

}  // namespace

Job asking_job(const Picture& picture) {
    Job job;
    job.scene = picture.job.scene;
    job.files = picture.job.files;
    job.isa = picture.job.isa;
    job.width = job.height = 1;
    job.graph.file = "carrier.lua";
    job.graph.nodes = {{"trivial", "Trivial", {}, {}, {}},
                       {"asker",
                        "Asker",
                        {Value{NodeRef{"trivial"}}},
                        {{"scene", Value{NodeRef{"scene"}}}, {"film", Value{Table{{Value{1.0}, Value{1.0}}, {}}}}},
                        {}},
                       {"scene", "Scene", {Value{job.scene}}, {}, {}}};
    job.tuning.bundle = bundle;
    job.tuning.credit = in_flight;
    return job;
}

Plan one_asks_the_other(const PlaceAt& first, const PlaceAt& second) {
    Plan plan{{first, second}, std::vector<std::vector<std::uint32_t>>(3)};
    plan.places_of[asker] = {0};
    plan.places_of[trivial] = {1};
    return plan;
}

namespace {

double questions_per_second(Carrier& carrier, const Plan& plan) {
    MasterRenderer::Job job;
    job.run = asking_run;
    job.image = asker;
    job.width = 2;  // emission, trivial
    job.tiles.resize(in_flight, Tile{0, 0, 1, 1, 0, 1});
    job.credit = {in_flight, in_flight};
    return static_cast<double>(asks * bundle) / seconds_of([&] {
               MasterRenderer master(std::move(job), carrier, [](const Tile&, std::span<const Rgb>) {});
               master.use(plan);
               while (!master.work(50ms)) {
               }
           });
}

// ---- side by side ---------------------------------------------------------------------------------------------------

// Keeps the full way's launcher in touch with its hosts while the plain way is measured.
double measured_beside(Carrier& carrier, PlainPair& plain) {
    std::atomic<double> speed{0};
    const std::jthread thread([&] { speed = double(asks * bundle) / plain.seconds_of(asks, in_flight); });
    while (speed == 0) {
        carrier.wait(20ms);
        carrier.receive();
    }
    return speed;
}

}  // namespace

void measure_asking(Carrier& carrier, const Plan& plan, const std::function<std::string(std::size_t)>& plain_endpoint,
                    const std::vector<Beside>& besides) {
    std::vector<double> full_speeds;
    std::vector<std::vector<double>> ratios(besides.size()), plain_speeds(besides.size());
    std::vector<std::unique_ptr<PlainPair>> pairs;
    for (std::size_t i = 0; i < besides.size(); ++i)
        pairs.push_back(std::make_unique<PlainPair>(plain_endpoint(i), besides[i].load, bundle, besides[i].line));
    for (int round = 0; round < rounds; ++round) {
        full_speeds.push_back(questions_per_second(carrier, plan));
        for (std::size_t i = 0; i < besides.size(); ++i) {
            plain_speeds[i].push_back(measured_beside(carrier, *pairs[i]));
            ratios[i].push_back(full_speeds.back() / plain_speeds[i].back());
        }
    }
    for (std::size_t i = 0; i < besides.size(); ++i) {
        std::printf("  %s: %.2f million questions per second, plain ZeroMQ %.2f\n", besides[i].name,
                    median(full_speeds) / 1e6, median(plain_speeds[i]) / 1e6);
        figure(besides[i].name, ratios[i], 0.6, true);
    }
}

}  // namespace lightnet::bench
