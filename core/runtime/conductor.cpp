#include "core/runtime/conductor.hpp"

#include <algorithm>
#include <cstring>
#include <span>

#include "core/error.hpp"

namespace lightnet {
namespace {

// The channels of a master are told apart from those of the one before it, whose late replies mean something else.
constexpr unsigned epoch_bits = 20;
constexpr std::uint32_t channel_mask = (1u << epoch_bits) - 1;
constexpr std::uint32_t own_channel = 0xffffffff;

template <class T>
std::vector<T> values_of(const Bytes& data) {
    std::vector<T> values(data ? data->size() / sizeof(T) : 0);
    if (!values.empty()) std::memcpy(values.data(), data->data(), values.size() * sizeof(T));
    return values;
}

}  // namespace

Conductor::Conductor(Options options, Carrier& carrier)
    : options_(std::move(options)),
      carrier_(carrier),
      calls_(*options_.graph, options_.made_from, options_.cache),
      order_(preparing_nodes(*options_.graph, *options_.registry)),
      locks_(std::any_of(options_.graph->nodes.begin(), options_.graph->nodes.end(),
                         [&](const Node& node) { return options_.registry->find(node.kind)->locks; })) {
    proposal_.places_of.resize(options_.graph->nodes.size());
    in_force_ = proposal_;
}

Conductor::~Conductor() = default;

// ---- plans ----------------------------------------------------------------------------------------------------------

void Conductor::propose(const Plan& plan) {
    std::set<PlaceKey> gone;
    for (const auto& place : proposal_.places) gone.insert({place.host, place.index});
    for (const auto& place : plan.places) gone.erase({place.host, place.index});
    proposal_ = plan;
    lose(gone);
    if (rehearsing_) {  // nobody will ask a place that holds the node no more what it has noted
        const auto places = holders(done_);
        rehearsing_->broken |= std::any_of(rehearsing_->places.begin(), rehearsing_->places.end(), [&](const auto& at) {
            return std::find(places.begin(), places.end(), at) == places.end();
        });
    }
    advance();
}

// What was asked of them is asked of others; what a rehearsal had noted there is lost, so it begins again.
void Conductor::lose(const std::set<PlaceKey>& gone) {
    if (gone.empty()) return;
    for (auto sent = sent_.begin(); sent != sent_.end();) {
        if (!gone.contains(sent->second.place)) {
            ++sent;
            continue;
        }
        const auto& [place, position, step] = sent->second;
        if (step.kind == Step::Kind::shard) calls_.of(order_[position], step.call).take_back(step.shard);
        sent = sent_.erase(sent);
    }
    std::erase_if(followers_, [&](const auto& follower) { return gone.contains(follower.first.first); });
    for (const auto& place : gone) {
        known_prepared_.erase(place);
        attended_.erase(place);
        heard_of_.erase(place);
        desk_.lose(place);
        std::erase_if(grants_, [&](const auto& grant) { return grant.first == place; });
    }
    if (rehearsing_) rehearsing_->broken = true;
}

std::vector<Conductor::PlaceKey> Conductor::holders(std::size_t position) const {
    std::vector<PlaceKey> places;
    for (const auto place : proposal_.places_of[order_[position]])
        places.emplace_back(proposal_.places[place].host, proposal_.places[place].index);
    return places;
}

bool Conductor::is_done(const PlaceKey& place, std::size_t position) const {
    const auto found = followers_.find({place, position});
    return found != followers_.end() && found->second.state == Follower::State::done;
}

Plan Conductor::restricted() {
    std::vector<bool> asked(proposal_.places.size(), true);
    for (std::size_t position = 0; position < done_; ++position)
        for (const auto place : proposal_.places_of[order_[position]]) {
            const PlaceKey key{proposal_.places[place].host, proposal_.places[place].index};
            if (!known_prepared_.contains(key) && !is_done(key, position)) asked[place] = false;
        }
    if (rehearsing_)  // who came in its middle would not note what it is asked
        for (const auto place : proposal_.places_of[order_[done_]])
            if (!rehearsing_->places.contains({proposal_.places[place].host, proposal_.places[place].index}))
                asked[place] = false;
    for (std::size_t place = 0; place < asked.size(); ++place)
        if (asked[place]) known_prepared_.insert({proposal_.places[place].host, proposal_.places[place].index});
    Plan plan = proposal_;
    for (auto& places : plan.places_of) std::erase_if(places, [&](auto place) { return !asked[place]; });
    for (std::size_t position = 0; position < done_; ++position)
        std::erase_if(plan.places_of[order_[position]], [&](auto place) {
            return !is_done({proposal_.places[place].host, proposal_.places[place].index}, position);
        });
    return plan;
}

void Conductor::enforce() {
    auto plan = restricted();
    if (plan == in_force_) return;
    in_force_ = std::move(plan);
    carrier_.adopt(in_force_);
    Message message;
    message.type = Message::Type::plan;
    message.run = options_.run;
    message.plan = std::make_shared<const Plan>(in_force_);
    arrived_.push_back(std::move(message));
}

// ---- leading --------------------------------------------------------------------------------------------------------

void Conductor::advance() {
    bool more = true;
    while (more) {
        for (std::size_t position = 0; position <= done_ && position < order_.size(); ++position)
            for (const auto& place : holders(position)) lead(place, position);
        more = false;
        if (done_ < order_.size()) {
            const auto places = holders(done_);
            more = !places.empty() &&
                   std::all_of(places.begin(), places.end(), [&](const auto& place) { return is_done(place, done_); });
            if (more) ++done_;
        }
    }
    collect();
    enforce();
    attend();
}

// Keeps an ear at every place, and passes locks on.
void Conductor::attend() {
    if (!locks_) return;
    for (const auto& place : proposal_.places) {
        const PlaceKey key{place.host, place.index};
        if (attended_.contains(key)) continue;
        const bool anew = !heard_of_.contains(key);
        if (!send(key, 0, {.kind = Step::Kind::attend, .call = anew})) continue;
        attended_.insert(key);
        heard_of_.insert(key);
    }
    for (auto& grant : desk_.granted()) grants_.push_back(std::move(grant));
    std::erase_if(grants_, [&](const auto& grant) {
        return send(grant.first, 0, {.kind = Step::Kind::grant, .data = grant.second});
    });
}

void Conductor::heard(const Sent& sent, const Bytes& data) {
    if (sent.step.kind == Step::Kind::grant) return;
    attended_.erase(sent.place);
    for (const auto& word : values_of<LockWord>(data))
        if (word.kind <= LockWord::Kind::last) desk_.hear(sent.place, word);
    attend();
}

void Conductor::lead(const PlaceKey& place, std::size_t position) {
    auto& follower = followers_[{place, position}];
    if (follower.state == Follower::State::idle) {
        // Inputs are prepared before those who ask them: at every place, in the order of all.
        for (std::size_t before = 0; before < position; ++before) {
            const auto places = holders(before);
            const bool holds = std::find(places.begin(), places.end(), place) != places.end();
            if (holds && !is_done(place, before)) return;
        }
        if (send(place, position, {.kind = Step::Kind::prepare})) follower.state = Follower::State::asked;
    } else if (follower.state == Follower::State::waiting) {
        auto& call = calls_.reported(order_[position], follower.at);
        if (!call.result()) {
            if (follower.at.kind == Report::Kind::map) hand_out(place, position, call);
        } else if (carrier_.bring({place.first, place.second}, call.name(), call.result()) &&
                   send(place, position, {.kind = Step::Kind::go_on, .call = follower.at.call, .data = call.name()})) {
            follower.state = Follower::State::asked;
        }
    }
}

void Conductor::hand_out(const PlaceKey& place, std::size_t position, Call& call) {
    auto& follower = followers_[{place, position}];
    while (const auto shard = call.hand_out(follower.shards)) {
        const Step step{.kind = Step::Kind::shard, .call = follower.at.call, .shard = *shard};
        if (!send(place, position, step)) return call.take_back(*shard);
        ++follower.shards;
    }
}

bool Conductor::send(const PlaceKey& place, std::size_t position, Step step) {
    Message message;
    message.run = options_.run;
    message.channel = own_channel;
    message.bundle = next_;
    message.width = step.kind == Step::Kind::attend ? 0 : 1;
    message.node = step.kind < Step::Kind::attend ? static_cast<std::uint32_t>(order_[position]) : 0;
    message.questions = std::make_shared<const std::vector<Step>>(1, step);
    if (step.kind == Step::Kind::go_on) message.data = calls_.of(order_[position], step.call).result();
    if (!carrier_.ask({place.first, place.second}, message)) return false;
    sent_[next_++] = {place, position, step};
    return true;
}

// ---- answers --------------------------------------------------------------------------------------------------------

void Conductor::take(Message message) {
    const auto found = sent_.find(message.bundle);
    if (found == sent_.end()) return;  // of a place that was lost
    const Sent sent = found->second;
    sent_.erase(found);
    const bool shard = sent.step.kind == Step::Kind::shard;
    if (shard) {
        --followers_[{sent.place, sent.position}].shards;
        if (calls_.of(order_[sent.position], sent.step.call).result()) return;  // another place was first
    }
    if (message.type == Message::Type::failure) throw Error(message.text);
    if (sent.step.kind >= Step::Kind::attend) {
        heard(sent, message.data);
    } else if (shard) {
        shard_done(sent, message.data);
    } else if (sent.step.kind == Step::Kind::collect) {
        noted(sent, message.data);
    } else {
        reported(sent, message.data);
    }
}

void Conductor::reported(const Sent& sent, const Bytes& data) {
    Report report;
    if (data && data->size() >= sizeof report) std::memcpy(&report, data->data(), sizeof report);
    if (!data || data->size() < sizeof report || report.kind > Report::Kind::last)
        throw Error("'" + name_of(sent.position) + "': a report of preparing is damaged");
    say(sent.position, {reinterpret_cast<const char*>(data->data()) + sizeof report, data->size() - sizeof report});
    auto& follower = followers_[{sent.place, sent.position}];
    follower.at = report;
    follower.state = follower.at.kind == Report::Kind::done ? Follower::State::done : Follower::State::waiting;
    advance();
}

// Each line once, however many places say it.
void Conductor::say(std::size_t position, std::string_view lines) {
    while (!lines.empty()) {
        const auto end = std::min(lines.find('\n'), lines.size());
        const std::string line = name_of(position) + ": " + std::string(lines.substr(0, end));
        if (said_.insert(line).second) options_.say(line);
        lines.remove_prefix(std::min(end + 1, lines.size()));
    }
}

void Conductor::shard_done(const Sent& sent, const Bytes& data) {
    auto& call = calls_.of(order_[sent.position], sent.step.call);
    if (!call.answer(sent.step.shard, data)) {
        const auto places = holders(sent.position);  // a host that was told to stop gets no more
        if (std::find(places.begin(), places.end(), sent.place) != places.end())
            hand_out(sent.place, sent.position, call);
        return;
    }
    call.complete_from_shards();
    calls_.keep(order_[sent.position], sent.step.call);
    advance();
}

// ---- the carrier's face ---------------------------------------------------------------------------------------------

bool Conductor::prepare(std::chrono::nanoseconds most) {
    const auto end = std::chrono::steady_clock::now() + most;
    while (true) {
        advance();
        if (done_ == order_.size()) return true;
        const auto left = end - std::chrono::steady_clock::now();
        if (left.count() <= 0) return false;
        if (rehearsing_ && !rehearsing_->rendered) {
            rehearsing_->rendered = rehearsing_->master->work(left);
            if (rehearsing_->broken) end_rehearsal();
            continue;
        }
        if (rehearsing_ && rehearsing_->broken) end_rehearsal();
        wait(std::min<std::chrono::nanoseconds>(left, std::chrono::milliseconds(20)));
        while (receive()) {
        }
    }
}

bool Conductor::ask(const PlaceAt& to, Message& message) {
    const auto channel = message.channel;
    message.channel |= epoch_ << epoch_bits;
    if (carrier_.ask(to, message)) return true;
    message.channel = channel;
    return false;
}

void Conductor::give_up(std::uint32_t channel) { carrier_.give_up(channel | epoch_ << epoch_bits); }

std::optional<Message> Conductor::receive() {
    while (true) {
        if (!arrived_.empty()) {
            auto message = std::move(arrived_.front());
            arrived_.pop_front();
            return message;
        }
        auto message = carrier_.receive();
        if (!message) return std::nullopt;
        if (message->run != options_.run) continue;
        if (message->type == Message::Type::plan) {
            if (message->plan) propose(*message->plan);
        } else if (message->channel == own_channel) {
            take(std::move(*message));
        } else if (message->channel >> epoch_bits == epoch_) {
            message->channel &= channel_mask;
            return message;
        }
    }
}

void Conductor::wait(std::chrono::nanoseconds most) {
    if (!arrived_.empty()) return;
    carrier_.wait(most);
    if (!followers_.empty() && in_force_ != proposal_) advance();  // someone is catching up
    attend();
}

const std::string& Conductor::name_of(std::size_t position) const {
    return options_.graph->nodes[order_[position]].name;
}

std::string Conductor::progress() const {
    if (done_ == order_.size()) return {};
    std::string text = name_of(done_);
    const auto* call = calls_.unfinished(order_[done_]);
    if (!call) return text;
    if (call->what().kind == Report::Kind::rehearse) return text + ": rehearsal";
    return text + ": " + std::to_string(call->what().count - call->missing()) + "/" +
           std::to_string(call->what().count);
}

}  // namespace lightnet
