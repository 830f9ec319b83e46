#include "core/run/master/shard_work.hpp"

#include <algorithm>
#include <set>
#include <vector>

#include "core/base/error.hpp"
#include "core/network/graph/layout.hpp"
#include "core/run/master/epoch.hpp"

namespace lightnet {
namespace {

void throw_error_of(const ShardDealer& dealer) {
    if (dealer.error()) throw Error(*dealer.error());
}

}  // namespace

ShardWork::Work& ShardWork::begin(const Call& of, ServiceCall& call) {
    ShardDealer::Job job{at_.state.graph.nodes[of.first].name, of.second, call.what().count};
    if (at_.verify > 0) job.checks = {at_.verify, secret_number()};
    job.check = [&call](std::uint32_t count, const Bytes& joined) { call.check(count, joined); };
    job.done = [&call](std::uint32_t first, const Bytes& joined) { call.take(first, joined); };
    job.at_fault = [this](const Failure& failure) { at_.carrier.take_out(failure.host, failure.why); };
    job.doubt = [this, node = of.first](Failure lie) {
        if (!answers_alone(at_.state.proposed, at_.state.graph, node)) lie.host.clear();
        at_.carrier.doubt(lie);
    };
    return works_.try_emplace(of, std::move(job)).first->second;
}

void ShardWork::join(const NodeCopy& copy, std::size_t position, ServiceCall& call) {
    const Call of{at_.state.order.node(position), call.what().call};
    const auto known = works_.find(of);
    auto& work = known == works_.end() ? begin(of, call) : known->second;
    if (work.lines.contains(copy)) return;
    const auto number = free_number();
    RemoteChannel<Step>::Address address;
    address.run = at_.run;
    address.channel = Epoch::own(number);
    address.node = static_cast<std::uint32_t>(copy.node);
    address.place = copy.place;
    address.process = at_.state.proposed.process_of(copy.place.host);
    address.within_process = copy.place.host.empty();
    auto channel = std::make_unique<RemoteChannel<Step>>(at_.carrier, address, ShardDealer::credit_of_each, counters_);
    by_number_[number] = {&work, channel.get()};
    work.lines.emplace(copy, Line{std::move(channel), number});
    use_lines(work);
}

// One that replies may still name is not used again so soon.
std::uint32_t ShardWork::free_number() {
    constexpr auto most = Epoch::most_channels - 1;  // the last one is for steps of other kinds
    while (by_number_.contains(next_number_)) next_number_ = (next_number_ + 1) % most;
    return std::exchange(next_number_, (next_number_ + 1) % most);
}

void ShardWork::close(const Line& line) {
    by_number_.erase(line.number);
    at_.carrier.give_up(Epoch::own(line.number));
}

void ShardWork::use_lines(Work& work) {
    std::vector<Channel<Step>*> all, draining;
    for (const auto& [copy, line] : work.lines) {
        all.push_back(line.channel.get());
        if (line.draining) draining.push_back(all.back());
    }
    work.dealer.use(std::move(all), draining);
}

void ShardWork::keep() {
    const auto& plan = at_.state.proposed;
    const std::set<PlaceAt> places(plan.places.begin(), plan.places.end());
    for (auto& [of, work] : works_) {
        std::vector<Line> lost;  // until the dealer knows
        for (auto known = work.lines.begin(); known != work.lines.end();) {
            auto& [copy, line] = *known;
            line.draining = !holds(plan, copy.place, copy.node);
            if (places.contains(copy.place)) {
                ++known;
                continue;
            }
            close(line);
            lost.push_back(std::move(line));
            known = work.lines.erase(known);
        }
        use_lines(work);
        throw_error_of(work.dealer);
    }
}

void ShardWork::let_go(const NodeCopy& copy) {
    for (auto& [of, work] : works_) {
        const auto known = work.lines.extract(copy);  // until the dealer knows
        if (!known) continue;
        close(known.mapped());
        use_lines(work);
        throw_error_of(work.dealer);
    }
}

// What nobody else can be asked about waits for those who may come.
void ShardWork::deal(std::size_t position) {
    const auto node = at_.state.order.node(position);
    for (auto work = works_.lower_bound({node, 0}); work != works_.end() && work->first.first == node; ++work) {
        const auto all = at_.state.copies(position);
        for (const auto& [copy, line] : work->second.lines) line.channel->go_by(at_.state.in_force.edition);
        work->second.copies = all.size();
        work->second.more = at_.carrier.expects_hosts() ||
                            std::ranges::any_of(all, [&](const auto& copy) { return will_join(copy, work->first); });
        deal(work->second);
    }
}

void ShardWork::deal(Work& work) {
    work.dealer.deal(work.copies, work.more);
    throw_error_of(work.dealer);
}

// It does no shards of this call yet, but will; all copies make the same calls.
bool ShardWork::will_join(const NodeCopy& copy, const Call& of) const {
    const auto found = at_.state.followers.find(copy);
    if (found == at_.state.followers.end() || found->second.state == Follower::State::idle) return true;
    const bool past = found->second.state == Follower::State::done || found->second.at.call > of.second;
    return !past && !works_.at(of).lines.contains(copy);
}

bool ShardWork::arrived(Message& message) {
    const auto known = by_number_.find(Epoch::channel_of(message.channel));
    if (known == by_number_.end()) return false;
    const auto [work, channel] = known->second;
    channel->arrived(message);
    if (work->dealer.missing() == 0) return true;
    deal(*work);
    return false;
}

bool ShardWork::end_calls() {
    bool ended = false;
    for (auto work = works_.begin(); work != works_.end();) {
        if (work->second.dealer.missing() > 0) {
            ++work;
            continue;
        }
        const auto [node, number] = work->first;
        for (const auto& [copy, line] : work->second.lines) close(line);
        work = works_.erase(work);
        at_.calls.of(node, number).complete_from_shards();
        at_.calls.keep(node, number);
        at_.state.goes_on();
        ended = true;
    }
    return ended;
}

void ShardWork::forget(std::size_t position) {
    const auto node = at_.state.order.node(position);
    std::erase_if(works_, [&](const auto& work) {
        if (work.first.first != node) return false;
        for (const auto& [copy, line] : work.second.lines) close(line);
        return true;
    });
}

}  // namespace lightnet
