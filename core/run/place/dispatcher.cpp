#include "core/run/place/dispatcher.hpp"

#include <algorithm>
#include <utility>

#include "core/base/error.hpp"
#include "core/run/message/place_name.hpp"

namespace lightnet {

// ---- one node -------------------------------------------------------------------------------------------------------

template <class Question>
Dispatcher::Desk<Question>::Desk(Dispatcher& all, std::uint32_t node, RemoteChannels<Question>& channels)
    : all_(all), channels_(channels) {
    const auto& tuning = all.tuning_;
    edge_ = {node, {tuning.credit, tuning.credit_questions, tuning.credit_bytes}, {}};
    MultiplexerRules rules;
    rules.scheduling.strategy = all.plan_.strategy_of(node);
    rules.names_host = true;
    rules.clock = all.clock_;
    if (tuning.check_answers) rules.differs = [](const std::string& what) { throw Error(what); };
    places_.follow(std::move(rules), &all.counters_);
    connect();
}

template <class Question>
void Dispatcher::Desk<Question>::connect() {
    const Plan plan = all_.for_desk(edge_.node);
    // Who asks may not have heard yet that the node has moved away: those who had it answer what comes.
    if (!plan.places_of[edge_.node].empty()) channels_.connect(edge_, places_, plan);
}

template <class Question>
void Dispatcher::Desk<Question>::take(Message ask) {
    if (std::get<Questions<Question>>(ask.questions)->empty() || !in_hand_.take(ask)) return;
    const Bundle<Question> bundle{std::get<Questions<Question>>(std::move(ask.questions)), this, next_++, ask.width};
    ask.questions = {};
    asks_.emplace(bundle.number, std::move(ask));
    places_.send(bundle);
}

template <class Question>
void Dispatcher::Desk<Question>::cancel(const std::set<std::uint64_t>& askers) {
    for (auto ask = asks_.begin(); ask != asks_.end();) {
        if (!askers.contains(ask->second.asker)) {
            ++ask;
            continue;
        }
        places_.forget({nullptr, this, ask->first, 1});
        in_hand_.let_go(AsksInHand::name_of(ask->second));
        ++all_.counters_.cancelled;
        ask = asks_.erase(ask);
    }
}

template <class Question>
void Dispatcher::Desk<Question>::reply(const Bundle<Question>& bundle, const std::function<void(Message&)>& say) {
    auto ask = asks_.extract(bundle.number);
    if (ask.empty()) return;
    Message reply = reply_to(ask.mapped());
    reply.route = in_hand_.let_go(AsksInHand::name_of(ask.mapped()));
    say(reply);
    reply.load = places_.load();
    all_.carrier_.reply(std::move(reply));
}

template <class Question>
void Dispatcher::Desk<Question>::answered(const Bundle<Question>& bundle, std::vector<Rgb> answers) {
    reply(bundle, [&](Message& reply) { reply.answers = std::move(answers); });
}

template <class Question>
void Dispatcher::Desk<Question>::failed(const Bundle<Question>& bundle, const Failure& failure) {
    reply(bundle, [&](Message& reply) {
        reply.type = Message::Type::failure;
        reply.trouble = failure;
    });
}

// ---- all of them ----------------------------------------------------------------------------------------------------

Dispatcher::Dispatcher(std::string host, std::uint64_t run, std::size_t nodes, const Tuning& tuning, Carrier& carrier,
                       std::function<double()> clock)
    : host_(std::move(host)),
      run_(run),
      tuning_(tuning),
      carrier_(carrier),
      clock_(std::move(clock)),
      light_channels_(carrier, run, {host_, name_of({host_, any_place})}, dealt_),
      image_channels_(carrier, run, {host_, name_of({host_, any_place}), first_for_tiles}, dealt_) {
    plan_.places_of.resize(nodes);
}

// The plan with no other places for the node than this host's.
Plan Dispatcher::for_desk(std::uint32_t node) const {
    Plan plan = plan_;
    const auto is_here = [&](std::uint32_t place) { return plan.places[place].host == host_; };
    auto& holders = plan.places_of[node];
    std::erase_if(holders, [&](auto place) { return !is_here(place); });
    return plan;
}

void Dispatcher::use(const Plan& plan) {
    const auto before = std::exchange(plan_, plan);
    const auto lost = lost_names(before, plan_);
    for_each_desk([&](auto& desk) {
        if (!lost.empty()) desk.cancel(lost);
        desk.connect();
    });
    for (auto& ask : later_.due(plan_.edition))
        if (!lost.contains(ask.asker)) take(std::move(ask));
}

template <class Question>
void Dispatcher::take(Message ask, std::map<std::uint32_t, Desk<Question>>& desks, RemoteChannels<Question>& channels) {
    const auto node = ask.node;
    auto desk = desks.find(node);
    if (desk == desks.end()) desk = desks.try_emplace(node, *this, node, channels).first;
    desk->second.take(std::move(ask));
}

void Dispatcher::take(Message message) {
    if (message.run != run_) return;
    switch (message.type) {
        case Message::Type::ask:
            if (message.node >= plan_.places_of.size() || later_.keep(message, plan_.edition)) return;
            if (std::holds_alternative<Questions<Query>>(message.questions))
                take(std::move(message), light_, light_channels_);
            else if (std::holds_alternative<Questions<Tile>>(message.questions))
                take(std::move(message), images_, image_channels_);
            return;  // steps are for places that they name
        case Message::Type::reply:
        case Message::Type::failure:
            if (message.channel < first_for_tiles) return light_channels_.arrived(message);
            return image_channels_.arrived(message);
        case Message::Type::plan:
            if (message.plan) use(*message.plan);
            return;
        case Message::Type::stop:
            stopping_ = true;
            return;
    }
}

void Dispatcher::step() {
    while (auto message = carrier_.receive()) take(std::move(*message));
    for_each_desk([](auto& desk) { desk.tick(); });
}

std::chrono::nanoseconds Dispatcher::until_due() const {
    std::chrono::nanoseconds least = std::chrono::milliseconds(100);
    for (const auto& [node, desk] : light_) least = std::min(least, desk.until_due());
    for (const auto& [node, desk] : images_) least = std::min(least, desk.until_due());
    return least;
}

void Dispatcher::serve(const std::atomic<bool>& stop) {
    while (!stopping_ && !stop.load(std::memory_order_relaxed)) {
        step();
        carrier_.wait(until_due());
    }
}

Counters Dispatcher::counters() const {
    Counters counters = counters_;
    counters += carrier_.counters();
    counters.dealt = dealt_.bundles;
    return counters;
}

}  // namespace lightnet
