// What it costs to carry questions. This file: questions per second from node to node, beside plain ZeroMQ that moves
// the same bytes.
//
// The full way of a question: a fiber of the asking place asks, and parks; a bundle of 256 goes through ZeroMQ to the
// answering place, whose node is called in a fiber; the reply comes back and wakes the asker. Eight fibers ask at a
// time. Over inproc both places are threads of one ThreadedRun. Over tcp each is the only place of a host (here in this
// process, where lightnetd would have them), and a bundle goes as a packet from the place's own socket to the door of
// the other host, through the door to its place, and back.
//
// The plain way: one DEALER and one ROUTER, eight messages under way, 48 bytes per question there, 12 per answer back.
// Questions are written, read, answered by the same function and the answers copied out, like on the full way.
#include <array>
#include <atomic>
#include <chrono>
#include <cstring>
#include <thread>
#include <zmq.hpp>

#include "core/network/light/light_op.hpp"
#include "core/network/light/node_context.hpp"
#include "core/network/light/renderer.hpp"
#include "core/run/runtime/master_renderer.hpp"
#include "nodes/standard_nodes.hpp"
#include "tests/bench/figure.hpp"
#include "tests/bench/picture.hpp"
#include "tests/bench/scalar.hpp"
#include "tests/bench/two_hosts.hpp"
#include "transport/launcher/threaded_run.hpp"

namespace lightnet::bench {
namespace {

using namespace std::chrono_literals;

constexpr std::size_t bundle = 256;  // questions
constexpr std::size_t in_flight = 8;
constexpr std::size_t asks = 8000;  // bundles per measurement
constexpr int rounds = 9;
constexpr std::uint64_t run_id = 1;

Rgb answer_to(const Query& question) { return {question.u, question.v, question.outgoing.x}; }

std::vector<Query> some_questions() {
    std::vector<Query> questions(bundle);
    for (std::size_t i = 0; i < bundle; ++i) {
        questions[i].stream = 0x9e3779b97f4a7c15ull * (i + 1);
        questions[i].primitive = static_cast<std::uint32_t>(i);
        questions[i].u = 0.5f / static_cast<float>(i + 1);
        questions[i].v = 0.25f;
        questions[i].outgoing = {0, 0, 1};
    }
    return questions;
}

void expect_answers(std::span<const Query> questions, std::span<const Rgb> answers) {
    for (std::size_t i = 0; i < questions.size(); ++i)
        if (answers[i] != answer_to(questions[i])) throw std::runtime_error("a wrong answer came back");
}

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
    explicit Asker(const NodeContext& here) : inputs_(here.inputs()), questions_(some_questions()) {}
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

Registry asking_kinds() {
    return Registry(
        {{.name = "Trivial",
          .help = "answers at once",
          .make_light = [](const NodeContext&) { return std::make_unique<Trivial>(); }},
         {.name = "Asker",
          .role = Role::image,
          .help = "asks",
          .inputs = {1, 1},
          .params = {{.name = "scene", .type = ParamType::scene, .help = "what hosts read, and nobody asks"}},
          .make_renderer = [](const NodeContext& here) { return std::make_unique<Asker>(here); }}});
}

constexpr std::size_t trivial = 0, asker = 1;

Job asking_job(const Picture& picture) {
    Job job;
    job.scene = picture.job.scene;
    job.files = picture.job.files;
    job.isa = picture.job.isa;
    job.width = job.height = 1;
    job.graph.file = "carrier.lua";
    job.graph.nodes = {{"trivial", "Trivial", {}, {}, {}},
                       {"asker", "Asker", {Value{NodeRef{"trivial"}}}, {{"scene", Value{NodeRef{"scene"}}}}, {}},
                       {"scene", "Scene", {Value{job.scene}}, {}, {}}};
    job.tuning.bundle = bundle;
    job.tuning.credit = in_flight;
    return job;
}

// The first place asks the second.
Plan one_asks_the_other(const PlaceAt& first, const PlaceAt& second) {
    Plan plan{{first, second}, std::vector<std::vector<std::uint32_t>>(3)};
    plan.places_of[asker] = {0};
    plan.places_of[trivial] = {1};
    return plan;
}

double questions_per_second(Carrier& carrier, const Plan& plan) {
    MasterRenderer::Job job;
    job.run = run_id;
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

// ---- the plain way --------------------------------------------------------------------------------------------------

zmq::message_t message_of(const void* data, std::size_t size) { return {data, size}; }

void set_up(zmq::socket_t& socket) {
    socket.set(zmq::sockopt::sndhwm, 0);
    socket.set(zmq::sockopt::rcvhwm, 0);
    socket.set(zmq::sockopt::linger, 0);
}

// Answers until an empty message comes.
void answer_plainly(zmq::socket_t& router) {
    std::vector<Query> questions(bundle);
    while (true) {
        zmq::message_t route, message;
        (void)router.recv(route);
        (void)router.recv(message);
        if (message.size() == 0) return;
        std::memcpy(questions.data(), message.data(), message.size());
        zmq::message_t reply(bundle * sizeof(Rgb));
        for (std::size_t i = 0; i < bundle; ++i) {
            const Rgb answer = answer_to(questions[i]);
            std::memcpy(static_cast<std::byte*>(reply.data()) + i * sizeof answer, &answer, sizeof answer);
        }
        router.send(route, zmq::send_flags::sndmore);
        router.send(reply, zmq::send_flags::none);
    }
}

double plain_questions_per_second(zmq::socket_t& dealer) {
    const auto questions = some_questions();
    std::vector<Rgb> answers(bundle);
    const auto send = [&] { dealer.send(message_of(questions.data(), bundle * sizeof(Query)), zmq::send_flags::none); };
    const double seconds = seconds_of([&] {
        for (std::size_t i = 0; i < in_flight; ++i) send();
        for (std::size_t i = 0; i < asks; ++i) {
            zmq::message_t message;
            (void)dealer.recv(message);
            std::memcpy(answers.data(), message.data(), message.size());
            if (i + in_flight < asks) send();
        }
    });
    expect_answers(questions, answers);
    return static_cast<double>(asks * bundle) / seconds;
}

class PlainPair {
public:
    explicit PlainPair(const std::string& endpoint)
        : dealer_(endpoint.starts_with("inproc") ? context_ : other_, zmq::socket_type::dealer) {
        set_up(router_);
        set_up(dealer_);
        router_.bind(endpoint);
        dealer_.connect(router_.get(zmq::sockopt::last_endpoint));
        answerer_ = std::jthread([this] { answer_plainly(router_); });
    }
    ~PlainPair() { dealer_.send(zmq::message_t(), zmq::send_flags::none); }
    double questions_per_second() { return plain_questions_per_second(dealer_); }

private:
    // Over tcp each end has a context, and so a thread of ZeroMQ's own, as in two processes; inproc knows only one.
    zmq::context_t context_{1}, other_{1};
    zmq::socket_t router_{context_, zmq::socket_type::router}, dealer_;
    std::jthread answerer_;
};

// ---- side by side ---------------------------------------------------------------------------------------------------

// Keeps the full way's launcher in touch with its hosts while the plain way is measured.
double measured_beside(Carrier& carrier, PlainPair& plain) {
    std::atomic<double> speed{0};
    const std::jthread thread([&] { speed = plain.questions_per_second(); });
    while (speed == 0) {
        carrier.wait(20ms);
        carrier.receive();
    }
    return speed;
}

void measure(const char* name, Carrier& carrier, const Plan& plan, const std::string& plain_endpoint) {
    PlainPair plain(plain_endpoint);
    std::vector<double> ratios, full_speeds, plain_speeds;
    for (int round = 0; round < rounds; ++round) {
        plain_speeds.push_back(measured_beside(carrier, plain));
        full_speeds.push_back(questions_per_second(carrier, plan));
        ratios.push_back(full_speeds.back() / plain_speeds.back());
    }
    std::printf("  %s: %.2f million questions per second, plain ZeroMQ %.2f\n", name, median(full_speeds) / 1e6,
                median(plain_speeds) / 1e6);
    show("of plain ZeroMQ", ratios);
    figure(name, median(ratios), 0.6, true);
}

void measure_inproc(const Picture& picture) {
    const Registry kinds = asking_kinds();
    const Job job = asking_job(picture);
    const auto network = build_network(job, kinds, LoadedScene{});
    const Plan plan = one_asks_the_other({"", 0}, {"", 1});
    ThreadedRun run(network, run_id, plan, job.tuning);
    measure("carrier.inproc", run.carrier(), plan, "inproc://plain");
    run.stop();
}

void measure_tcp(const Picture& picture) {
    const Registry kinds = asking_kinds();
    TwoHosts hosts(kinds, picture, run_id, asking_job(picture), one_asks_the_other);
    measure("carrier.tcp", hosts.cluster(), hosts.cluster().plan(), "tcp://127.0.0.1:*");
    hosts.cluster().finish();
}

}  // namespace
}  // namespace lightnet::bench

int main(int argc, char** argv) {
    namespace bench = lightnet::bench;
    const std::string only = argc > 1 ? argv[1] : "";
    return lightnet::bench::run("carrier", [&] {
        const lightnet::Registry registry{lightnet::standard_nodes()};
        const bench::Picture picture(registry, 128, 16);
        if (only.empty() || only == "inproc") bench::measure_inproc(picture);
        if (only.empty() || only == "tcp") bench::measure_tcp(picture);
        if (only.empty() || only == "scalar_inproc") bench::measure_scalar_inproc(picture);
        if (only.empty() || only == "scalar_tcp") bench::measure_scalar_tcp(picture);
    });
}
