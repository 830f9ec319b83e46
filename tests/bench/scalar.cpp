#include "tests/bench/scalar.hpp"

#include <atomic>
#include <chrono>
#include <stdexcept>

#include "core/network/light/light_op.hpp"
#include "core/network/light/renderer.hpp"
#include "core/network/light/wrap.hpp"
#include "core/run/master/master_renderer.hpp"
#include "tests/bench/figure.hpp"
#include "tests/bench/two_hosts.hpp"
#include "transport/launcher/threaded_run.hpp"

namespace lightnet {
namespace bench {
namespace {

/// Traditional code: asks its input again and again, and waits each time.
class Patient {
public:
    explicit Patient(OneByOne& input) : input_(input) {}
    void ask(const Query& question) {
        Query next = question;
        for (std::uint32_t i = 0; i < times; ++i) {
            next.u = static_cast<float>(i);
            if (input_.ask(0, next).r != next.u) throw std::runtime_error("a wrong answer came back");
        }
    }
    static constexpr std::uint32_t times = 200;

private:
    OneByOne& input_;
};

}  // namespace
}  // namespace bench

template <>
struct Bridge<bench::Patient> {
    Bridge(const NodeContext&, OneByOne& inputs) : instance_(inputs) {}
    Rgb light(const Query& question) {
        instance_.ask(question);
        return {1, 1, 1};
    }

private:
    bench::Patient instance_;
};

namespace bench {
namespace {

using namespace std::chrono_literals;

const std::size_t patients = sized<std::size_t>(2048, 64);  // at a time
const double asks = double(patients) * Patient::times;
constexpr std::uint64_t run_id = 1;
const int rounds = repeated(9);
enum : std::size_t { answerer, patient, asker };

/// Answers at once.
class Echo final : public LightOp {
public:
    void light(std::span<const Query> questions, std::span<Rgb> answers) const override {
        for (std::size_t i = 0; i < questions.size(); ++i) answers[i] = {questions[i].u, questions[i].v, 0};
    }
};

/// Asks the wrapped node of its own place, and answers with the seconds that its thread has computed meanwhile.
class Watch final : public Renderer {
public:
    explicit Watch(const NodeContext& here) : inputs_(here.inputs()) {}
    void render_block(const Tile&, std::span<Rgb> pixels) const override {
        const std::vector<Query> questions(patients);
        const double begun = thread_seconds();
        const Part part = ask(inputs_, 0, questions);
        pixels[0].r = static_cast<float>(thread_seconds() - begun);
        for (const auto& answer : part.answers)
            if (answer != Rgb{1, 1, 1}) throw std::runtime_error("a wrong answer came back");
    }

private:
    Inputs inputs_;
};

Registry kinds() {
    return Registry(
        {{.name = "Echo",
          .help = "answers at once",
          .make_light = [](const NodeContext&) { return std::make_unique<Echo>(); }},
         wrap<Patient>("Patient", {.help = "asks one by one", .inputs = {1, 1}}),
         {.name = "Watch",
          .role = Role::image,
          .help = "asks, and takes the time",
          .inputs = {1, 1},
          .params = {{.name = "scene", .type = ParamType::scene, .help = "what hosts read, and nobody asks"},
                     {.name = "film", .type = ParamType::film, .help = "which jobs have to have"}},
          .make_renderer = [](const NodeContext& here) { return std::make_unique<Watch>(here); }}});
}

Job scalar_job(const Picture& picture) {
    return picture.of_nodes(
        "scalar.lua", {{"answerer", "Echo", {}, {}, {}},
                       {"patient", "Patient", {Value{NodeRef{"answerer"}}}, {}, {}},
                       {"asker",
                        "Watch",
                        {Value{NodeRef{"patient"}}},
                        {{"scene", Value{NodeRef{"scene"}}}, {"film", Value{Table{{Value{1.0}, Value{1.0}}, {}}}}},
                        {}}});
}

Plan asked_elsewhere(const PlaceAt& first, const PlaceAt& second) {
    Plan plan{{first, second}, std::vector<std::vector<std::uint32_t>>(4)};
    plan.places_of[asker] = plan.places_of[patient] = {0};
    plan.places_of[answerer] = {1};
    return plan;
}

/// Has the asker ask once. Returns the seconds that its thread computed.
double round(Carrier& carrier, const Plan& plan) {
    MasterRenderer::Job job;
    job.run = run_id;
    job.image = asker;
    job.width = 2;  // emission, patient
    job.tiles = {Tile{0, 0, 1, 1, 0, 1}};
    double seconds = 0;
    MasterRenderer master(std::move(job), carrier,
                          [&](const Tile&, std::span<const Rgb> pixels) { seconds = double{pixels[0].r}; });
    master.use(plan);
    while (!master.work(50ms)) {
    }
    return seconds;
}

void report(const char* name, const std::vector<double>& each_ns, const Counters& counters, double goal) {
    std::printf("  %.0f questions per bundle\n",
                static_cast<double>(counters.questions) / static_cast<double>(counters.bundles));
    quantity(name, each_ns, "ns of processor time per question", goal, false);
}

}  // namespace

void measure_scalar_inproc(const Picture& picture) {
    const Registry registry = kinds();
    const Job job = scalar_job(picture);
    const Plan plan = asked_elsewhere({"", 0}, {"", 1});
    ThreadedRun run(build_network(job, registry, LoadedScene{}), run_id, plan, job.tuning);
    std::vector<double> each;
    for (int i = 0; i < rounds; ++i) each.push_back(1e9 * round(run.carrier(), plan) / asks);
    report("carrier.scalar_inproc", each, run.stop(), 150);
}

void measure_scalar_tcp(const Picture& picture) {
    const Registry registry = kinds();
    TwoHosts hosts(registry, picture, run_id, scalar_job(picture), asked_elsewhere);
    Cluster& cluster = hosts.cluster();
    std::vector<double> each;
    for (int i = 0; i < rounds; ++i) {
        const double before = process_seconds();
        round(cluster, cluster.plan());
        each.push_back(1e9 * (process_seconds() - before) / asks);
    }
    report("carrier.scalar_tcp", each, cluster.finish(), 400);
}

}  // namespace bench
}  // namespace lightnet
