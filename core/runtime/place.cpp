#include "core/runtime/place.hpp"

#include <algorithm>
#include <numeric>

#include "core/error.hpp"
#include "core/scene/scene.hpp"

namespace lightnet {
Place::Place(const Network& network, const PlaceAt& me, const Plan& plan, std::uint64_t run, PlaceRules rules,
             Carrier& carrier)
    : network_(network),
      me_(me),
      plan_(plan),
      run_(run),
      rules_(rules),
      carrier_(carrier),
      rays_before_(Scene::rays_of_this_thread()),
      rounds_(fibers_, rules.side_fibers, [this](Fibers::Fiber* fiber) { ready_.push_back(fiber); }),
      inboxes_(network.graph.nodes.size()),
      by_rank_(network.graph.nodes.size()),
      locks_(
          fibers_, [this](Fibers::Fiber* fiber) { ready_.push_back(fiber); },
          [this](Message reply) { carrier_.reply(std::move(reply)); }),
      assembly_(
          network, [this](std::size_t node, std::size_t width) { return port_to(node, width); }, locks_, &rounds_),
      preparer_(network, assembly_, fibers_,
                {my_name(), [this](Fibers::Fiber* fiber) { ready_.push_back(fiber); },
                 [this](Message reply) { carrier_.reply(std::move(reply)); },
                 [this](std::size_t node) { return plan_.places_of[node].size(); }}) {
    const auto rank = ranks_of(network.graph);
    std::iota(by_rank_.begin(), by_rank_.end(), 0);
    std::stable_sort(by_rank_.begin(), by_rank_.end(), [&](auto a, auto b) { return rank[a] < rank[b]; });
    for (std::size_t node = 0; node < plan_.places_of.size(); ++node)
        if (std::any_of(plan_.places_of[node].begin(), plan_.places_of[node].end(),
                        [&](auto i) { return plan_.places[i] == me_; }))
            assemble(node);
}

void Place::assemble(std::size_t node) {
    if (network_.kind_of(node).role == Role::light) assembly_.light(node);
    if (network_.kind_of(node).role == Role::image) assembly_.renderer(node);
}

Place::~Place() { fibers_.cancel_all(); }

std::string Place::my_name() const {
    return me_.host.empty() ? "place " + std::to_string(me_.index) : me_.host + " place " + std::to_string(me_.index);
}

Port* Place::port_to(std::size_t node, std::size_t width) {
    const auto& holders = plan_.places_of[node];
    const bool mine = std::any_of(holders.begin(), holders.end(), [&](auto i) { return plan_.places[i] == me_; });
    if (mine && rules_.call_own_nodes) {
        const auto called = assembly_.called(node);
        return call_ports_
            .emplace_back(std::make_unique<CallPort>(called, width, counters_.local_questions, [this] { pause(); }))
            .get();
    }
    auto& remote = remotes_[{node, width}];
    if (!remote.port) {
        remote.node = node;
        remote.port = std::make_unique<BundlePort>(
            fibers_, [this](Fibers::Fiber* fiber) { ready_.push_back(fiber); }, width, rules_.bundles);
        connect(remote);
    }
    return remote.port.get();
}

// Makes the replicas of a port those of the plan: opens channels to new places.
void Place::connect(Remote& remote) {
    std::map<std::pair<std::string, std::uint32_t>, std::uint32_t> channels;
    std::vector<Channel<Query>*> replicas;
    for (const auto place : plan_.places_of[remote.node]) {
        const auto& at = plan_.places[place];
        const std::pair key{at.host, at.index};
        const auto known = remote.channels.find(key);
        if (known != remote.channels.end()) {
            channels.insert(*known);
        } else {
            const auto number = static_cast<std::uint32_t>(channels_.size());
            channels_.push_back(std::make_unique<RemoteChannel<Query>>(
                carrier_, RemoteChannel<Query>::Ends{run_, number, static_cast<std::uint32_t>(remote.node), at},
                rules_.credit, counters_));
            channels[key] = number;
        }
        replicas.push_back(channels_[channels[key]].get());
    }
    remote.channels = std::move(channels);
    remote.port->replicas().use(std::move(replicas));
}

void Place::use(const Plan& plan) {
    plan_ = plan;
    for (auto& [key, remote] : remotes_) connect(remote);
    close_absent(channels_, plan_);
}

void Place::serve(const std::atomic<bool>& stop, std::atomic<std::uint64_t>& progress) {
    stop_ = &stop;
    progress_ = &progress;
    while (!stopping_ && !stop.load(std::memory_order_relaxed)) {
        take_in();
        flush(false);
        if (!step()) {
            if (!flush(true)) carrier_.wait(patience());
            continue;
        }
        // Looking at the sockets costs calls of the system: what has come together is worked off together.
        while (Clock::now() - last_look_ < std::chrono::microseconds(50) && step()) {
        }
    }
    stopping_ = true;
    fibers_.cancel_all();
}

// Runs one thing: fibers whose answers are there, then bundles of the lowest rank, then more of what nodes do side by
// side, then paused work, then new tiles.
bool Place::step() {
    const auto resume_first_of = [&](auto& queue) {
        if (queue.empty()) return false;
        auto* fiber = queue.front();
        queue.pop_front();
        fibers_.resume(fiber);
        return true;
    };
    return resume_first_of(ready_) || preparer_.start_next() || start_next(false) || rounds_.start_one() ||
           resume_first_of(paused_) || start_next(true);
}

bool Place::may_start(std::size_t node) const {
    const auto& inbox = inboxes_[node];
    return !inbox.waiting.empty() && (inbox.fibers == 0 || spare_in_use_ < rules_.spare_fibers);
}

bool Place::start_next(bool images) {
    for (const auto node : by_rank_) {
        if (!may_start(node) || (network_.kind_of(node).role == Role::image) != images) continue;
        auto& inbox = inboxes_[node];
        auto message = std::make_shared<Message>(std::move(inbox.waiting.front()));
        inbox.waiting.pop_front();
        fibers_.start(network_.graph.nodes[node].name.c_str(), [this, message] { answer(*message); });
        return true;
    }
    return false;
}

void Place::take_in() {
    while (auto message = carrier_.receive()) take(std::move(*message));
    last_look_ = Clock::now();
}

void Place::take(Message message) {
    switch (message.type) {
        case Message::Type::ask: {
            if (message.run != run_ || message.node >= inboxes_.size()) return;
            if (const auto* steps = std::get_if<Questions<Step>>(&message.questions)) {
                const auto kind = (*steps)->front().kind;
                if (kind == Step::Kind::shard) return queue(std::move(message), 1);
                if (kind >= Step::Kind::attend) return locks_.take(std::move(message));
                if (network_.kind_of(message.node).prepares) preparer_.take(std::move(message));
            } else if (const auto* queries = std::get_if<Questions<Query>>(&message.questions)) {
                queue(std::move(message), (*queries)->size());
            } else {
                queue(std::move(message), 1);
            }
            return;
        }
        case Message::Type::reply:
        case Message::Type::failure:
            if (message.run == run_ && message.channel < channels_.size()) channels_[message.channel]->arrived(message);
            return;
        case Message::Type::plan:
            if (message.run == run_ && message.plan) use(*message.plan);
            return;
        case Message::Type::stop:
            if (message.run == run_) stopping_ = true;
            return;
    }
}

void Place::queue(Message message, std::size_t questions) {
    auto& inbox = inboxes_[message.node];
    inbox.questions += questions;
    inbox.waiting.push_back(std::move(message));
}

void Place::answer(Message& message) {
    auto& inbox = inboxes_[message.node];
    const bool spare = inbox.fibers++ > 0;
    spare_in_use_ += spare;
    const auto* fiber = fibers_.current();
    Message reply = reply_to(message);
    const bool pixels = std::holds_alternative<Questions<Tile>>(message.questions);
    std::size_t count = 1;
    try {
        if (pixels) {
            reply.answers = pixel_answers(message);
        } else if (const auto* steps = std::get_if<Questions<Step>>(&message.questions)) {
            reply.data = preparer_.shard(message.node, (*steps)->front());
        } else {
            count = std::get<Questions<Query>>(message.questions)->size();
            reply.answers = light_answers(message);
        }
    } catch (const Cancelled&) {
        throw;
    } catch (const std::exception& error) {
        reply.type = Message::Type::failure;
        // What a light operator threw has its name already.
        reply.text = (pixels ? "'" + network_.graph.nodes[message.node].name + "' " : std::string()) + "on " +
                     my_name() + ": " + error.what();
    }
    const double ns =
        static_cast<double>(fibers_.running_time(fiber).count()) / static_cast<double>(std::max(count, std::size_t{1}));
    inbox.service_ns = inbox.service_ns > 0 ? 0.8 * inbox.service_ns + 0.2 * ns : ns;
    inbox.questions -= std::min(inbox.questions, count);
    message.questions = {};  // before the reply: the asker writes its next questions there
    --inbox.fibers;
    spare_in_use_ -= spare;
    reply.load = load_of(message.node);
    carrier_.reply(std::move(reply));
    progress_->fetch_add(1, std::memory_order_relaxed);
}

std::vector<Rgb> Place::light_answers(const Message& message) {
    const auto& questions = *std::get<Questions<Query>>(message.questions);
    const std::size_t layers = network_.width_of(message.node);
    if (network_.kind_of(message.node).role != Role::light || (message.width != 1 && message.width != layers))
        throw Error("was asked for light in a way that its graph does not have");
    std::vector<Rgb> answers(questions.size() * message.width);
    lightnet::answer(assembly_.called(message.node), message.width, questions, answers);
    return answers;
}

std::vector<Rgb> Place::pixel_answers(const Message& message) {
    const auto& tiles = *std::get<Questions<Tile>>(message.questions);
    const std::size_t layers = network_.width_of(message.node);
    if (network_.kind_of(message.node).role != Role::image || message.width != layers)
        throw Error("was asked for pixels in a way that its graph does not have");
    std::vector<Rgb> pixels(answers_to(tiles, layers));
    std::size_t first = 0;
    for (const auto& tile : tiles) {
        const std::size_t size = tile.pixels() * layers;
        assembly_.renderer(message.node).render(tile, std::span(pixels).subspan(first, size));
        first += size;
        ++counters_.tiles;
    }
    return pixels;
}

// Called by running work at every ask of a node of this place: a busy place still serves others.
void Place::pause() {
    auto* fiber = fibers_.current();
    if (!fiber) return;
    const auto now = Clock::now();
    if (now - last_look_ < std::chrono::microseconds(200)) return;
    take_in();
    if (stopping_ || (stop_ && stop_->load(std::memory_order_relaxed))) throw Cancelled{};
    flush(false);
    const bool others = !ready_.empty() || std::any_of(by_rank_.begin(), by_rank_.end(), [&](auto node) {
        return may_start(node) && network_.kind_of(node).role == Role::light;
    });
    if (!others) return;
    paused_.push_back(fiber);
    fibers_.park();
}

bool Place::flush(bool idle) {
    const auto now = Clock::now();
    bool sent = false;
    for (auto& [key, remote] : remotes_) sent |= remote.port->flush(now, idle);
    return sent;
}

std::chrono::nanoseconds Place::patience() const {
    std::chrono::nanoseconds least = std::chrono::milliseconds(100);
    const auto now = Clock::now();
    for (const auto& [key, remote] : remotes_) least = std::min(least, remote.port->until_due(now));
    return least;
}

Load Place::load_of(std::size_t node) const {
    const auto& inbox = inboxes_[node];
    return {static_cast<std::uint32_t>(inbox.questions),
            static_cast<std::uint32_t>(std::clamp(inbox.service_ns, 1.0, 4e9))};
}

Counters Place::counters() const {
    Counters counters = counters_;
    counters += carrier_.counters();
    counters.rays = Scene::rays_of_this_thread() - rays_before_;
    return counters;
}

}  // namespace lightnet
