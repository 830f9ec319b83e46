#include "core/run/master/coordinator.hpp"

#include <algorithm>
#include <cstring>

#include "core/base/error.hpp"
#include "core/network/graph/layout.hpp"

namespace lightnet {
namespace {

constexpr std::uint32_t own_channel = Epoch::own(Epoch::most_channels - 1);

}  // namespace

Coordinator::Coordinator(Options options, Carrier& carrier)
    : options_(std::move(options)),
      carrier_(carrier),
      calls_(*options_.graph, options_.made_from, options_.cache, renewed_nodes(*options_.graph, *options_.registry)),
      shards_({options_.run, options_.verify,
               [this](std::size_t node, Failure lie) { doubt_shards(node, std::move(lie)); }},
              carrier_),
      order_(preparing_nodes(*options_.graph, *options_.registry)),
      stages_(stages_of(order_, *options_.graph, *options_.registry)) {
    const auto& nodes = options_.graph->nodes;
    if (std::any_of(nodes.begin(), nodes.end(),
                    [&](const Node& node) { return options_.registry->find(node.kind)->run.locks; }))
        locks_.emplace([this](const PlaceAt& place, const Step& step) { return send({{place, 0}, 0, step}); });
    plans_.proposed.places_of.resize(options_.graph->nodes.size());
    plans_.in_force = plans_.proposed;
}

Coordinator::~Coordinator() = default;

// ---- plans ----------------------------------------------------------------------------------------------------------

void Coordinator::propose(const Plan& plan) {
    std::set<PlaceAt> gone(plans_.proposed.places.begin(), plans_.proposed.places.end());
    for (const auto& place : plan.places) gone.erase(place);
    const Plan before = std::exchange(plans_.proposed, plan);
    note_who_left(before);
    lose(gone);
    keep_dealing();
    if (rehearsal_ && !std::all_of(rehearsal_->copies().begin(), rehearsal_->copies().end(),
                                   [&](const auto& copy) { return is_there(copy, done_); }))
        rehearsal_->break_off();  // nobody will ask a place that holds the node no more what it has noted
    advance();
}

// What was asked of them is asked of others; what a rehearsal had noted there is lost, so it begins again.
void Coordinator::lose(const std::set<PlaceAt>& gone) {
    if (gone.empty()) return;
    for (auto sent = sent_.begin(); sent != sent_.end();) {
        if (!gone.contains(sent->second.to.place)) {
            ++sent;
            continue;
        }
        sent = sent_.erase(sent);
    }
    std::erase_if(followers_, [&](const auto& follower) { return gone.contains(follower.first.place); });
    for (const auto& place : gone) {
        known_prepared_.erase(place);
        if (locks_) locks_->lose(place);
    }
    if (rehearsal_) rehearsal_->break_off();
}

// The node itself, or those that stand for its sectors.
std::vector<std::size_t> Coordinator::nodes_at(std::size_t position) const {
    auto nodes = sectors_of(*options_.graph, order_[position]);
    if (nodes.empty()) nodes.push_back(order_[position]);
    return nodes;
}

std::vector<NodeCopy> Coordinator::copies(std::size_t position) const {
    std::vector<NodeCopy> copies;
    for (const auto node : nodes_at(position))
        for (const auto place : plans_.proposed.places_of[node])
            copies.push_back({plans_.proposed.places[place], node});
    return copies;
}

bool Coordinator::is_there(const NodeCopy& copy, std::size_t position) const {
    const auto all = copies(position);
    return std::find(all.begin(), all.end(), copy) != all.end();
}

bool Coordinator::is_done(const NodeCopy& copy) const {
    const auto found = followers_.find(copy);
    return found != followers_.end() && found->second.state == Follower::State::done;
}

// ---- leading --------------------------------------------------------------------------------------------------------

// Up to where: what is prepared, for those who come late, and the whole stage of what is not.
std::size_t Coordinator::led() const {
    std::size_t end = done_;
    while (end < order_.size() && stages_[end] <= done_) ++end;
    return end;
}

void Coordinator::advance() {
    end_calls();
    bool more = true;
    while (more) {
        for (std::size_t position = 0; position < led(); ++position)
            for (const auto& copy : copies(position)) lead(copy, position);
        more = end_calls();  // that waited for nothing but somebody to join
        if (done_ < order_.size()) {
            const bool done = can_be_asked(done_);
            if (done) ++done_, went_on_ = steady_seconds();
            more = more || done;
        }
    }
    for (std::size_t position = 0; position < led(); ++position) deal(position);
    collect();
    enforce();
    if (locks_) locks_->attend(plans_.proposed.places);
}

void Coordinator::lead(const NodeCopy& copy, std::size_t position) {
    auto& follower = followers_[copy];
    if (follower.state == Follower::State::idle) {
        // Inputs are prepared before those who ask them: at every place, in the order of all.
        for (std::size_t before = 0; before < stages_[position]; ++before)
            for (const auto& earlier : copies(before))
                if (earlier.place == copy.place && !is_done(earlier)) return;
        const auto first = first_call_of(is_renewed(position) ? pass_ : 0);
        if (send({copy, position, {.kind = Step::Kind::prepare, .call = first}}))
            follower.state = Follower::State::asked;
    } else if (follower.state == Follower::State::waiting) {
        auto& call = calls_.reported(copy.node, follower.at);
        const auto result = calls_.result(copy.node, follower.at.call);
        if (!result) {
            if (call.shared_out())
                shards_.join(copy, {order_[position], follower.at.call}, call, name_of(position),
                             plans_.proposed.process_of(copy.place.host));
            return;
        }
        const Hash& name = call.name(calls_.part_of(copy.node, call));
        if (carrier_.bring(copy.place, name, result) &&
            send({copy, position, {.kind = Step::Kind::go_on, .call = follower.at.call, .data = name}}, result))
            follower.state = Follower::State::asked;
    }
}

bool Coordinator::send(const Sent& sent, const Bytes& data) {
    const auto& [to, position, step] = sent;
    Message message;
    message.run = options_.run;
    message.channel = own_channel;
    message.bundle = next_;
    message.width = step.kind == Step::Kind::attend ? 0 : 1;
    message.node = static_cast<std::uint32_t>(to.node);
    message.questions = std::make_shared<const std::vector<Step>>(1, step);
    message.data = data;
    if (!carrier_.ask(to.place, message)) return false;
    sent_[next_++] = sent;
    return true;
}

// ---- answers --------------------------------------------------------------------------------------------------------

void Coordinator::take(Message message) {
    const auto found = sent_.find(message.bundle);
    if (found == sent_.end()) return;  // of a place that was lost
    const Sent sent = found->second;
    sent_.erase(found);
    if (sent.step.kind == Step::Kind::leave) return;
    if (message.type == Message::Type::failure) return failed(sent, message.trouble.why);
    if (sent.step.kind == Step::Kind::attend) {
        if (!locks_) return;
        locks_->hear(sent.to.place, message.data);
        locks_->attend(plans_.proposed.places);
    } else if (sent.step.kind == Step::Kind::grant) {
        return;
    } else if (sent.step.kind == Step::Kind::collect) {
        noted(sent, message.data);
    } else {
        reported(sent, message.data);
    }
}

// A host that can't do its part of preparing is left out; what a second one can't do either is the run's own fault.
void Coordinator::failed(const Sent& sent, const std::string& why) {
    const auto& [to, position, step] = sent;
    const auto& host = to.place.host;
    auto& hosts = failed_at_[{position, step.kind, step.call}];
    hosts.insert(host);
    const auto all = copies(position);
    const bool others =
        std::any_of(all.begin(), all.end(), [&](const NodeCopy& copy) { return !hosts.contains(copy.place.host); });
    if (hosts.size() > 1 || !(others || expects_hosts())) throw Error(why);
    if (!carrier_.take_out(host, why)) throw Error(why);
}

void Coordinator::reported(const Sent& sent, const Bytes& data) {
    StepReport report;
    if (data && data->size() >= sizeof report) std::memcpy(&report, data->data(), sizeof report);
    if (!data || data->size() < sizeof report || report.kind > StepReport::Kind::last)
        return failed(
            sent, "'" + name_of(sent.position) + "' on " + sent.to.place.host + ": a report of preparing is damaged");
    say(sent.to.node, {reinterpret_cast<const char*>(data->data()) + sizeof report, data->size() - sizeof report});
    auto& follower = followers_[sent.to];
    follower.at = report;
    follower.state = follower.at.kind == StepReport::Kind::done ? Follower::State::done : Follower::State::waiting;
    let_go_of_taken(sent.position, report.call);
    advance();
}

// A copy has got past the calls before this one; others may be behind.
void Coordinator::let_go_of_taken(std::size_t position, std::uint32_t before) {
    if (is_first_call(before)) return;
    const auto all = copies(position);
    const bool taken = std::all_of(all.begin(), all.end(), [&](const NodeCopy& copy) {
        const auto& follower = followers_[copy];
        return follower.state == Follower::State::done ||
               (follower.state != Follower::State::idle && follower.at.call >= before);
    });
    if (taken) calls_.all_have(order_[position], before - 1);
}

// Each line once, however many places say it.
void Coordinator::say(std::size_t node, std::string_view lines) {
    while (!lines.empty()) {
        const auto end = std::min(lines.find('\n'), lines.size());
        const std::string line = options_.graph->nodes[node].name + ": " + std::string(lines.substr(0, end));
        if (said_.insert(line).second) options_.say(line);
        lines.remove_prefix(std::min(end + 1, lines.size()));
    }
}

// ---- the carrier's face ---------------------------------------------------------------------------------------------

bool Coordinator::prepare(std::chrono::nanoseconds most) {
    const auto end = std::chrono::steady_clock::now() + most;
    while (true) {
        advance();
        if (done_ == order_.size()) return true;
        const auto left = end - std::chrono::steady_clock::now();
        if (left.count() <= 0) return false;
        if (rehearsal_ && !rehearsal_->rendered()) {
            rehearsal_->render(left);
            if (rehearsal_->broken()) end_rehearsal();
            continue;
        }
        if (rehearsal_ && rehearsal_->broken()) end_rehearsal();
        wait(std::min<std::chrono::nanoseconds>(left, std::chrono::milliseconds(20)));
        while (receive()) {
        }
    }
}

bool Coordinator::ask(const PlaceAt& to, Message& message) {
    const auto channel = message.channel;
    message.channel = epoch_.marked(channel);
    if (carrier_.ask(to, message)) return true;
    message.channel = channel;
    return false;
}

void Coordinator::give_up(std::uint32_t channel) {
    if (channel < Epoch::most_channels) carrier_.give_up(epoch_.marked(channel));  // else nothing was ever asked by it
}

std::optional<Message> Coordinator::receive() {
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
        } else if (Epoch::is_own(message->channel)) {
            if (shards_.arrived(*message)) advance();
        } else if (epoch_.has(message->channel)) {
            message->channel = Epoch::channel_of(message->channel);
            return message;
        }
    }
}

void Coordinator::wait(std::chrono::nanoseconds most) {
    if (!arrived_.empty()) return;
    carrier_.wait(most);
    if (!followers_.empty() && plans_.in_force != plans_.proposed) advance();  // someone is catching up
    if (locks_) locks_->attend(plans_.proposed.places);
    let_go_of_left();
}

const std::string& Coordinator::name_of(std::size_t position) const {
    return options_.graph->nodes[order_[position]].name;
}

PrepareProgress Coordinator::progress() const {
    PrepareProgress progress;
    if (done_ == order_.size()) return progress;
    progress.node = name_of(done_);
    progress.position = done_ + 1, progress.nodes = order_.size();
    const auto* call = calls_.unfinished(order_[done_]);
    if (!call) return progress;
    if (call->shared_out())
        progress.done = call->what().count - call->missing(), progress.total = call->what().count;
    else if (rehearsal_)
        progress.done = rehearsal_->blocks_done(), progress.total = rehearsal_->blocks();
    return progress;
}

}  // namespace lightnet
