// What it costs to carry questions. This file: questions per second from node to node, beside plain ZeroMQ that moves
// the same bytes.
//
// The full way of a question: a fiber of the asking place asks, and parks; a bundle of 256 goes through ZeroMQ to the
// answering place, whose node is called in a fiber; the reply comes back and wakes the asker. Eight fibers ask at a
// time. Over inproc both places are threads of one ThreadedRun. Over tcp each is the only place of a host (here in this
// process, where lightnetd would have them), and a bundle goes as a packet from the place's own socket to the door of
// the other host, through the door to its place, and back.
//
// The plain way (plain_pair.hpp): one DEALER and one ROUTER, eight messages under way. Over tcp it moves as many bytes
// as our packets have, 256 questions each, and nothing is done with them but that they are copied into messages and out
// again. Within a process ours hands questions and answers over by pointer. It is measured beside a plain loop that
// does so as well, and beside one that copies 48 bytes per question there and 12 per answer back.
//
// What a bundle costs the system stands beside the speeds: calls of the system by who sends, receives and waits,
// switches of threads and processor time, which depend less on the machine. carrier.tcp_1 to _1024 have so many
// questions in a bundle.
//
// carrier.bytes counts the bytes of our packets per question, its answer included; 60 are what plain copies of both
// have.
#include <cstdio>
#include <string>

#include "nodes/standard_nodes.hpp"
#include "tests/bench/asking.hpp"
#include "tests/bench/figure.hpp"
#include "tests/bench/picture.hpp"
#include "tests/bench/plain_pair.hpp"
#include "tests/bench/scalar.hpp"
#include "tests/bench/two_hosts.hpp"
#include "transport/launcher/threaded_run.hpp"

namespace lightnet::bench {
namespace {

void measure_inproc(const Picture& picture) {
    const Registry kinds = asking_kinds();
    const Job job = asking_job(picture);
    const auto network = build_network(job, kinds, LoadedScene{});
    const Plan plan = one_asks_the_other({"", 0}, {"", 1});
    ThreadedRun run(network, asking_run, plan, job.tuning);
    measure_asking(run.carrier(), plan, [](std::size_t i) { return "inproc://plain" + std::to_string(i); },
                   {{"carrier.inproc_pointers", PlainLoad::pointers}, {"carrier.inproc_copies", PlainLoad::copies}});
    run.stop();
}

void measure_tcp(const Picture& picture, const std::string& name, std::size_t together) {
    const Registry kinds = asking_kinds();
    TwoHosts hosts(kinds, picture, asking_run, asking_job(picture, together), one_asks_the_other);
    measure_asking(
        hosts.cluster(), hosts.cluster().plan(), [](std::size_t) { return "tcp://127.0.0.1:*"; },
        {{name, PlainLoad::packets, PlainLine::open, together == asked_together}}, together);
    hosts.cluster().finish();
}

void measure_bytes() {
    const PacketSizes sizes = packet_sizes(asked_together);
    std::printf("  %zu questions: %zu bytes there and %zu back, frames of ZeroMQ not counted\n", asked_together,
                sizes.ask, sizes.reply);
    quantity("carrier.bytes", {double(sizes.ask + sizes.reply) / asked_together},
             "bytes per question; plain copies: 60", 48, false);
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
        if (only.empty() || only == "tcp") bench::measure_tcp(picture, "carrier.tcp", bench::asked_together);
        for (const std::size_t together : {1, 16, 1024})
            if (only.empty() || only == "sizes")
                bench::measure_tcp(picture, "carrier.tcp_" + std::to_string(together), together);
        if (only.empty() || only == "bytes") bench::measure_bytes();
        if (only.empty() || only == "scalar_inproc") bench::measure_scalar_inproc(picture);
        if (only.empty() || only == "scalar_tcp") bench::measure_scalar_tcp(picture);
    });
}
