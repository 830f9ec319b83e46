#include "core/run/master/shard_work.hpp"

#include <vector>

#include "core/base/error.hpp"
#include "core/run/master/epoch.hpp"

namespace lightnet {
namespace {

void throw_error_of(const ShardDealer& dealer) {
    if (dealer.error()) throw Error(*dealer.error());
}

}  // namespace

ShardWork::Work& ShardWork::begin(const Call& of, ServiceCall& call, const std::string& name) {
    ShardDealer::Job job{name, of.second, call.what().count};
    if (job_.verify > 0) job.checks = {job_.verify, secret_number()};
    job.check = [&call](std::uint32_t count, const Bytes& joined) { call.check(count, joined); };
    job.done = [&call](std::uint32_t first, const Bytes& joined) { call.take(first, joined); };
    job.at_fault = [this](const Failure& failure) { carrier_.take_out(failure.host, failure.why); };
    job.doubt = [this, node = of.first](const Failure& lie) { job_.doubt(node, lie); };
    return works_.try_emplace(of, std::move(job)).first->second;
}

void ShardWork::join(const NodeCopy& copy, const Call& of, ServiceCall& call, const std::string& name,
                     std::uint64_t process) {
    const auto known = works_.find(of);
    auto& work = known == works_.end() ? begin(of, call, name) : known->second;
    if (work.lines.contains(copy)) return;
    const auto number = free_number();
    auto channel = std::make_unique<RemoteChannel<Step>>(
        carrier_,
        RemoteChannel<Step>::Address{.run = job_.run,
                                     .channel = Epoch::own(number),
                                     .node = static_cast<std::uint32_t>(copy.node),
                                     .place = copy.place,
                                     .process = process,
                                     .within_process = copy.place.host.empty()},
        ShardDealer::credit_of_each, counters_);
    by_number_[number] = {&work, channel.get()};
    work.lines.emplace(copy, Line{std::move(channel), number});
    use_lines(work);
}

// Those of replies that may still come are not used again so soon.
std::uint32_t ShardWork::free_number() {
    constexpr auto most = Epoch::most_channels - 1;  // the last one is for steps of other kinds
    while (by_number_.contains(next_number_)) next_number_ = (next_number_ + 1) % most;
    return std::exchange(next_number_, (next_number_ + 1) % most);
}

void ShardWork::close(const Line& line) {
    by_number_.erase(line.number);
    carrier_.give_up(Epoch::own(line.number));
}

bool ShardWork::has(const NodeCopy& copy, const Call& of) const {
    const auto work = works_.find(of);
    return work != works_.end() && work->second.lines.contains(copy);
}

void ShardWork::use_lines(Work& work) {
    std::vector<Channel<Step>*> all, draining;
    for (const auto& [copy, line] : work.lines) {
        all.push_back(line.channel.get());
        if (line.draining) draining.push_back(all.back());
    }
    work.dealer.use(std::move(all), draining);
}

void ShardWork::keep(std::size_t node, const Plan& plan, const std::set<NodeCopy>& there) {
    const std::set<PlaceAt> places(plan.places.begin(), plan.places.end());
    for (auto of = works_.lower_bound({node, 0}); of != works_.end() && of->first.first == node; ++of) {
        auto& work = of->second;
        std::vector<Line> lost;  // until the dealer knows
        for (auto known = work.lines.begin(); known != work.lines.end();) {
            auto& [copy, line] = *known;
            line.draining = !there.contains(copy);
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

void ShardWork::deal(const Call& of, std::size_t copies, bool more) {
    const auto known = works_.find(of);
    if (known == works_.end()) return;
    known->second.copies = copies, known->second.more = more;
    deal(known->second);
}

void ShardWork::deal(Work& work) {
    work.dealer.deal(work.copies, work.more);
    throw_error_of(work.dealer);
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

void ShardWork::end(const Call& of) {
    const auto work = works_.find(of);
    if (work == works_.end()) return;
    for (const auto& [copy, line] : work->second.lines) close(line);
    works_.erase(work);
}

void ShardWork::end_all(std::size_t node) {
    for (auto of = works_.lower_bound({node, 0}); of != works_.end() && of->first.first == node;) end((of++)->first);
}

}  // namespace lightnet
