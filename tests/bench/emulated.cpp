#include "tests/bench/emulated.hpp"

#include <atomic>
#include <stdexcept>
#include <thread>

#include "core/network/light/light_op.hpp"
#include "core/network/light/node_context.hpp"
#include "core/network/light/renderer.hpp"
#include "core/run/assembly/fingerprint.hpp"
#include "core/run/master/master_renderer.hpp"
#include "tests/bench/figure.hpp"
#include "transport/launcher/cluster.hpp"
#include "transport/launcher/threaded_run.hpp"

namespace lightnet::bench {
namespace {

using Clock = std::chrono::steady_clock;

// One replica's share of the waiting. Waits that the system made too long are taken off the next ones.
class Cost {
public:
    Cost(double seconds, std::shared_ptr<Slowness> slowness)
        : seconds_(seconds), slowness_(std::move(slowness)), replica_(slowness_ ? slowness_->made++ : 0) {}

    void pay(double units) const {
        const double factor = slowness_ ? slowness_->of(replica_) : 1;
        const auto wanted =
            std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds_ * units * factor));
        const auto begun = Clock::now();
        std::this_thread::sleep_until(begun + wanted - std::min(*owed_, wanted));
        *owed_ = std::max(Clock::duration{}, *owed_ + (Clock::now() - begun) - wanted);
        *owed_ = std::min(*owed_, most_owed);
    }

private:
    static constexpr Clock::duration most_owed = std::chrono::milliseconds(20);
    double seconds_;
    std::shared_ptr<Slowness> slowness_;
    int replica_;
    std::unique_ptr<Clock::duration> owed_ = std::make_unique<Clock::duration>();
};

class EmulatedLight final : public LightOp {
public:
    EmulatedLight(const NodeContext& here, std::shared_ptr<Slowness> slowness)
        : inputs_(here.inputs()), cost_(here.number("microseconds") * 1e-6, std::move(slowness)) {}
    void light(std::span<const Query> questions, std::span<Rgb> answers) const override {
        cost_.pay(static_cast<double>(questions.size()));
        for (std::size_t i = 0; i < questions.size(); ++i) answers[i] = {1, questions[i].u, 0};
        for (const auto& part : ask_all(inputs_, questions)) lightnet::add(part, answers);
    }

private:
    Inputs inputs_;
    Cost cost_;
};

class EmulatedImage final : public Renderer {
public:
    EmulatedImage(const NodeContext& here, std::shared_ptr<Slowness> slowness)
        : inputs_(here.inputs()),
          questions_(static_cast<std::size_t>(here.number("questions"))),
          cost_(here.number("milliseconds") * 1e-3, std::move(slowness)) {}
    void render_block(const Tile& tile, std::span<Rgb> pixels) const override {
        cost_.pay(1);
        if (inputs_.empty()) return;
        std::vector<Query> questions(questions_);
        for (std::size_t i = 0; i < questions.size(); ++i) {
            questions[i].geometry = tile.x;
            questions[i].sample = static_cast<std::uint32_t>(i);
        }
        std::vector<Rgb> answers(questions.size() * inputs_.layers());
        for (const auto& part : ask_all(inputs_, questions)) lightnet::add(part, answers);
        for (std::size_t i = 0; i < answers.size(); ++i) pixels[i % inputs_.layers()] += answers[i];
    }

private:
    Inputs inputs_;
    std::size_t questions_;
    Cost cost_;
};

List refs(const std::vector<std::string>& inputs) {
    List list;
    for (const auto& input : inputs) list.push_back(Value{NodeRef{input}});
    return list;
}

}  // namespace

double Slowness::of(int replica) const {
    const auto known = static_cast<std::size_t>(replica) < of_replica.size();
    const double usual = known ? of_replica[static_cast<std::size_t>(replica)] : 1;
    return replica == slowed && Clock::now() >= slowed_at ? 10 * usual : usual;
}

Registry emulated_kinds(std::shared_ptr<Slowness> slowness, const std::string& slow_kind) {
    const auto of = [=](const std::string& kind) { return kind == slow_kind ? slowness : nullptr; };
    const auto light = of("EmulatedLight"), image = of("EmulatedImage");
    return Registry(
        {{.name = "EmulatedLight",
          .help = "waits",
          .inputs = {0, 8},
          .params = {{.name = "microseconds", .help = "per question"}},
          .make_light = [=](const NodeContext& here) { return std::make_unique<EmulatedLight>(here, light); }},
         {.name = "EmulatedImage",
          .role = Role::image,
          .help = "waits, and asks",
          .inputs = {0, 8},
          .params = {{.name = "milliseconds", .help = "per tile"},
                     {.name = "questions", .help = "per tile"},
                     {.name = "scene", .type = ParamType::scene, .help = "is not seen", .optional = true},
                     {.name = "film", .type = ParamType::film, .help = "which jobs have to have"}},
          .make_renderer = [=](const NodeContext& here) { return std::make_unique<EmulatedImage>(here, image); }}});
}

Node emulated_light(const std::string& name, double microseconds, const std::vector<std::string>& inputs) {
    return {name, "EmulatedLight", refs(inputs), {{"microseconds", Value{microseconds}}}, {}};
}

Node emulated_image(double milliseconds, double questions, const std::vector<std::string>& inputs) {
    return {"image",
            "EmulatedImage",
            refs(inputs),
            {{"milliseconds", Value{milliseconds}},
             {"questions", Value{questions}},
             {"film", Value{Table{{Value{1.0}, Value{1.0}}, {}}}}},
            {}};
}

double seconds_of_emulated(const Network& network, std::uint64_t run, Carrier& carrier, const Plan& plan,
                           std::size_t tiles, std::size_t in_flight, Counters* counters) {
    MasterRenderer::Job job;
    job.run = run;
    job.image = static_cast<std::uint32_t>(renderer_of(network.graph, network.registry));
    job.width = static_cast<std::uint32_t>(network.width_of(job.image));
    for (std::uint32_t i = 0; i < tiles; ++i) job.tiles.push_back({i, 0, 1, 1, 0, 1});
    job.credit = {in_flight, in_flight};
    std::size_t taken = 0;
    MasterRenderer master(std::move(job), carrier, [&](const Tile&, std::span<const Rgb>) { ++taken; });
    master.use(plan);
    const double seconds = seconds_of([&] {
        while (!master.work(std::chrono::milliseconds(100))) {
        }
    });
    if (taken != tiles) throw std::runtime_error("tiles are missing");
    if (counters) *counters = master.counters();
    return seconds;
}

double seconds_of_places(std::uint32_t places, double milliseconds, std::size_t tiles,
                         std::shared_ptr<Slowness> slowness) {
    constexpr std::uint64_t run_id = 1;
    const Registry kinds = emulated_kinds(slowness, "EmulatedImage");
    Job job;
    job.isa = usual_isa();
    job.graph.file = "emulated.lua";
    job.graph.nodes = {emulated_image(milliseconds, 0)};
    const auto network = build_network(job, kinds, LoadedScene{});
    const Plan all = plan(job.graph, kinds, {}, {{"", places}});
    ThreadedRun run(network, run_id, all, job.tuning);
    if (slowness->slowed >= 0) slowness->slowed_at += Clock::now().time_since_epoch();
    const double seconds = seconds_of_emulated(*network, run_id, run.carrier(), all, tiles * places, 2);
    run.stop();
    return seconds;
}

double seconds_of_hosts(const std::vector<std::string>& endpoints, const Picture& picture, std::size_t places,
                        double milliseconds, std::size_t tiles) {
    const Registry kinds = emulated_kinds(nullptr, "");
    Cluster::Options options;
    options.run = 1;
    options.job.scene = picture.job.scene;  // a host serves no run without one
    options.job.files = picture.job.files;
    options.job.isa = picture.job.isa;
    options.job.width = options.job.height = 1;
    options.job.graph.file = "emulated.lua";
    options.job.graph.nodes = {emulated_image(milliseconds, 0), {"scene", "Scene", {Value{picture.job.scene}}, {}, {}}};
    options.job.graph.nodes[0].params["scene"] = Value{NodeRef{"scene"}};
    options.files = picture.files;
    options.endpoints = endpoints;
    const Graph graph = options.job.graph;
    options.plan = [&](const std::vector<HostOffer>& offers) { return plan(graph, kinds, {}, offers); };
    const auto network = build_network(options.job, kinds, LoadedScene{});
    Cluster cluster(std::move(options));
    const std::atomic<bool> never{false};
    cluster.gather(std::chrono::seconds(20), never);
    cluster.adopt(cluster.plan());
    if (cluster.plan().places.size() != places) throw std::runtime_error("not all hosts are there");
    const double seconds = seconds_of_emulated(*network, 1, cluster, cluster.plan(), tiles * places, 2);
    cluster.finish();
    return seconds;
}

}  // namespace lightnet::bench
