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
#include "tests/bench/costs.hpp"
#include "tests/bench/figure.hpp"

namespace lightnet::bench {
namespace {

using namespace std::chrono_literals;

constexpr std::size_t in_flight = 8;
const std::size_t asks = sized<std::size_t>(8000, 200);  // bundles per measurement
const int rounds = repeated(9);

// ---- the full way ---------------------------------------------------------------------------------------------------

class Trivial final : public LightOp {
public:
    void light(std::span<const Query> questions, std::span<Rgb> answers) const override {
        for (std::size_t i = 0; i < questions.size(); ++i) answers[i] = answer_to(questions[i]);
        work_on(questions.size());
    }
};

// A renderer that asks, bundle after bundle, whatever the tile is.
class Asker final : public Renderer {
public:
    explicit Asker(const NodeContext& here)
        : inputs_(here.inputs()), questions_(some_questions(static_cast<std::size_t>(here.integer("together")))) {}
    void render_block(const Tile&, std::span<Rgb>) const override {
        std::vector<Rgb> answers(questions_.size());
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
                     {.name = "film", .type = ParamType::film, .help = "which jobs have to have"},
                     {.name = "together", .type = ParamType::integer, .help = "questions in a bundle"}},
          .make_renderer = [](const NodeContext& here) { return std::make_unique<Asker>(here); }}});
}

namespace {

constexpr std::size_t trivial = 0, asker = 1;

}  // namespace

Job asking_job(const Picture& picture, std::size_t together) {
    Job job = picture.of_nodes("carrier.lua", {{"trivial", "Trivial", {}, {}, {}},
                                               {"asker",
                                                "Asker",
                                                {Value{NodeRef{"trivial"}}},
                                                {{"scene", Value{NodeRef{"scene"}}},
                                                 {"film", Value{Table{{Value{1.0}, Value{1.0}}, {}}}},
                                                 {"together", Value{static_cast<double>(together)}}},
                                                {}}});
    job.tuning.bundle = static_cast<std::uint32_t>(together);
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

/// The time that all bundles take, and what each costs.
struct Measured {
    double seconds = 0;
    Costs bundle;
};

Measured measured(const std::function<void()>& work) {
    const auto before = costs_so_far();
    const double seconds = seconds_of(work);
    return {seconds, costs_since(before, static_cast<double>(asks))};
}

Measured full_way(Carrier& carrier, const Plan& plan) {
    MasterRenderer::Job job;
    job.run = asking_run;
    job.image = asker;
    job.width = 2;  // emission, trivial
    job.tiles.resize(in_flight, Tile{0, 0, 1, 1, 0, 1});
    job.credit = {in_flight, in_flight};
    return measured([&] {
        MasterRenderer master(std::move(job), carrier, [](const Tile&, std::span<const Rgb>) {});
        master.use(plan);
        while (!master.work(50ms)) {
        }
    });
}

}  // namespace

double seconds_of_bundle(Carrier& carrier, const Plan& plan) {
    return full_way(carrier, plan).seconds / static_cast<double>(asks);
}

double seconds_of_plain_bundle(PlainPair& plain) {
    return plain.seconds_of(asks, in_flight) / static_cast<double>(asks);
}

namespace {

// ---- side by side ---------------------------------------------------------------------------------------------------

// Keeps the full way's launcher in touch with its hosts while the plain way is measured.
Measured measured_beside(Carrier& carrier, PlainPair& plain) {
    std::atomic<bool> done{false};
    Measured found;
    {
        const std::jthread thread([&] {
            found = measured([&] { plain.seconds_of(asks, in_flight); });
            done = true;
        });
        while (!done) {
            carrier.wait(20ms);
            carrier.receive();
        }
    }
    return found;
}

std::vector<double> each(const std::vector<Measured>& all, double Costs::*cost) {
    std::vector<double> values;
    for (const auto& one : all) values.push_back(one.bundle.*cost);
    return values;
}

void show_costs(const char* way, const std::vector<Measured>& all) {
    std::printf("    %-12s %5.1f system calls, %4.1f switches, %5.1f us of processor time per bundle\n", way,
                median(each(all, &Costs::calls)), median(each(all, &Costs::switches)),
                1e6 * median(each(all, &Costs::seconds)));
}

std::vector<double> ratios(const std::vector<Measured>& full, const std::vector<Measured>& plain,
                           const std::function<double(const Measured&, const Measured&)>& ratio) {
    std::vector<double> values;
    for (std::size_t i = 0; i < full.size(); ++i) values.push_back(ratio(full[i], plain[i]));
    return values;
}

void report(const Beside& beside, const std::vector<Measured>& full, const std::vector<Measured>& plain,
            std::size_t together) {
    const auto speed = [&](const std::vector<Measured>& all) {
        std::vector<double> values;
        for (const auto& one : all) values.push_back(double(asks * together) / one.seconds / 1e6);
        return median(values);
    };
    std::printf("  %s: %.2f million questions per second, plain ZeroMQ %.2f\n", beside.name.c_str(), speed(full),
                speed(plain));
    show_costs("ours", full);
    show_costs("plain ZeroMQ", plain);
    figure(beside.name, ratios(full, plain, [](const auto& a, const auto& b) { return b.seconds / a.seconds; }), 0.6,
           true);
    if (!beside.costs) return;
    quantity(beside.name + ".calls", each(full, &Costs::calls), "system calls per bundle", 20, false);
    quantity(beside.name + ".switches", each(full, &Costs::switches), "switches per bundle", 2.5, false);
    figure(beside.name + ".processor",
           ratios(full, plain, [](const auto& a, const auto& b) { return a.bundle.seconds / b.bundle.seconds; }), 1.25,
           false);
}

}  // namespace

void measure_asking(Carrier& carrier, const Plan& plan, const std::function<std::string(std::size_t)>& plain_endpoint,
                    const std::vector<Beside>& besides, std::size_t together) {
    std::vector<Measured> full;
    std::vector<std::vector<Measured>> plain(besides.size());
    std::vector<std::unique_ptr<PlainPair>> pairs;
    for (std::size_t i = 0; i < besides.size(); ++i)
        pairs.push_back(std::make_unique<PlainPair>(plain_endpoint(i), besides[i].load, together, besides[i].line));
    for (int round = 0; round < rounds; ++round) {
        full.push_back(full_way(carrier, plan));
        for (std::size_t i = 0; i < besides.size(); ++i) plain[i].push_back(measured_beside(carrier, *pairs[i]));
    }
    for (std::size_t i = 0; i < besides.size(); ++i) report(besides[i], full, plain[i], together);
}

}  // namespace lightnet::bench
