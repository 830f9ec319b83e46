#include "transport/place_threads.hpp"

#include <atomic>
#include <thread>
#include <zmq.hpp>

#include "core/error.hpp"
#include "transport/sockets.hpp"
#include "transport/zmq_carrier.hpp"

namespace lightnet {
namespace {

std::string reports_endpoint(std::uint64_t run) { return "inproc://run-" + std::to_string(run) + "/reports"; }

}  // namespace

struct PlaceThreads::Threads {
    zmq::context_t& context;
    std::shared_ptr<const Network> network;
    std::uint64_t run;
    std::string host;
    Plan plan;
    PlaceRules rules;
    zmq::socket_t reports;  // PULL: a text per place, empty when it serves, else what is wrong
    std::vector<zmq::socket_t> to;
    std::atomic<bool> stop{false};
    std::vector<std::atomic<std::uint64_t>> progress;  // by place
    std::vector<Counters> counters;                    // each written by its place before it ends
    std::vector<std::jthread> threads;
    std::uint32_t serving = 0;

    void serve(std::uint32_t index);
    void report(const std::string& what);
};

void PlaceThreads::Threads::report(const std::string& what) {
    zmq::socket_t socket(context, zmq::socket_type::push);
    socket.set(zmq::sockopt::linger, 1000);
    socket.connect(reports_endpoint(run));
    Frames frames;
    frames.push_back(frame_of(what));
    send_frames(socket, frames);
}

void PlaceThreads::Threads::serve(std::uint32_t index) {
    try {
        ZmqCarrier carrier(context, {run, host, true, index});
        Place place(*network, {host, index}, plan, run, rules, carrier);
        report("");
        place.serve(stop, progress[index]);
        counters[index] = place.counters();
    } catch (const std::exception& error) {
        report("place " + std::to_string(index) + ": " + error.what());
    }
}

PlaceThreads::PlaceThreads(zmq::context_t& context, std::shared_ptr<const Network> network, std::uint64_t run,
                           std::string host, std::uint32_t count, Plan plan, PlaceRules rules)
    : threads_(new Threads{context,
                           std::move(network),
                           run,
                           std::move(host),
                           std::move(plan),
                           rules,
                           zmq::socket_t(context, zmq::socket_type::pull),
                           {},
                           {},
                           std::vector<std::atomic<std::uint64_t>>(count),
                           std::vector<Counters>(count),
                           {},
                           0}) {
    auto& t = *threads_;
    t.reports.set(zmq::sockopt::linger, 0);
    t.reports.bind(reports_endpoint(run));
    for (std::uint32_t index = 0; index < count; ++index) t.threads.emplace_back([&t, index] { t.serve(index); });
}

PlaceThreads::~PlaceThreads() {
    if (!threads_->threads.empty()) stop();
}

bool PlaceThreads::ready() {
    auto& t = *threads_;
    while (auto frames = receive_frames(t.reports)) {
        if (const auto what = text_of(frames->front()); !what.empty()) throw Error(what);
        ++t.serving;
    }
    if (t.serving < count()) return false;
    // inproc sockets connect only to what is bound, and all places have bound by now.
    while (t.to.size() < count())
        t.to.push_back(asking_socket(t.context, inproc_endpoint(t.run, static_cast<std::uint32_t>(t.to.size()))));
    return true;
}

void PlaceThreads::wait_until_ready() {
    while (!ready()) {
        zmq::pollitem_t item{threads_->reports.handle(), 0, ZMQ_POLLIN, 0};
        zmq::poll(&item, 1, std::chrono::milliseconds(100));
    }
}

void PlaceThreads::use(const Plan& plan) {
    const auto shared = std::make_shared<const Plan>(plan);
    for (auto& socket : threads_->to) {
        Message message;
        message.type = Message::Type::plan;
        message.run = threads_->run;
        message.plan = shared;
        Frames frames;
        frames.push_back(frame_of(std::move(message)));
        send_frames(socket, frames);
    }
}

Counters PlaceThreads::stop() {
    auto& t = *threads_;
    t.stop = true;
    for (auto& socket : t.to) {  // wakes those that wait for messages
        Message message;
        message.type = Message::Type::stop;
        message.run = t.run;
        Frames frames;
        frames.push_back(frame_of(std::move(message)));
        send_frames(socket, frames);
    }
    t.threads.clear();
    Counters sum;
    for (const auto& counters : t.counters) sum += counters;
    return sum;
}

std::uint32_t PlaceThreads::count() const { return static_cast<std::uint32_t>(threads_->counters.size()); }

std::uint64_t PlaceThreads::progress() const {
    std::uint64_t sum = 0;
    for (const auto& one : threads_->progress) sum += one.load(std::memory_order_relaxed);
    return sum;
}

zmq::socket_t& PlaceThreads::to(std::uint32_t place) { return threads_->to.at(place); }

zmq::socket_t& PlaceThreads::reports() { return threads_->reports; }

}  // namespace lightnet
