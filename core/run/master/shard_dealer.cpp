#include "core/run/master/shard_dealer.hpp"

#include <algorithm>
#include <memory>

#include "core/network/light/mapped.hpp"
#include "core/run/schedule/guided.hpp"

namespace lightnet {
namespace {

constexpr std::size_t shares_of_a_copy = 3;  // for each copy, see guided_share()

}  // namespace

ShardDealer::ShardDealer(Job job) : job_(std::move(job)), missing_(job_.count) {
    for (std::uint32_t shard = 0; shard < job_.count; ++shard) to_do_.push_back(shard);
    MultiplexerRules rules;
    rules.scheduling.last_to_idle = true;
    rules.scheduling.double_tail = true;
    rules.scheduling.tail_part = 1;  // nobody has anything else to do
    rules.clock = job_.clock;
    rules.checks = job_.checks;
    rules.own = "";
    rules.at_fault = job_.at_fault;
    rules.doubt = job_.doubt;
    replicas_.follow(std::move(rules));
}

void ShardDealer::deal(std::size_t copies, bool more) {
    replicas_.expect_hosts(more);
    const auto left = [this] { return to_do_.size() + alone_.size(); };
    replicas_.foresee(left());
    while (left() > 0 && replicas_.has_credit()) {
        const Step step = take_next(copies);
        replicas_.foresee(left());
        replicas_.send({std::make_shared<const std::vector<Step>>(1, step), this, 0});
    }
    replicas_.tick();
}

Step ShardDealer::take_next(std::size_t copies) {
    Step some{Step::Kind::shards, job_.call, 0, 1};
    if (!alone_.empty()) {
        some.first = alone_.back();
        alone_.pop_back();
        return some;
    }
    const auto most =
        job_.checks.any() ? 1 : guided_share(to_do_.size(), std::max<std::size_t>(1, copies), shares_of_a_copy);
    some.first = to_do_.front();
    to_do_.pop_front();
    while (!to_do_.empty() && to_do_.front() == some.first + some.count && some.count < most) {
        to_do_.pop_front();
        ++some.count;
    }
    return some;
}

void ShardDealer::put_back(std::uint32_t first, std::uint32_t end) {
    while (end > first) to_do_.push_front(--end);
}

std::string ShardDealer::mistake_in(const Bundle<Step>& bundle, const Bytes& joined, const std::string& host) {
    try {
        job_.check(bundle.questions->front().count, joined);
        return {};
    } catch (const Error& error) {
        return "'" + job_.node + "' on " + host + ": " + error.what();
    }
}

void ShardDealer::answered(const Bundle<Step>& bundle, Bytes joined) {
    const Step& step = bundle.questions->front();
    const auto done = static_cast<std::uint32_t>(split_shards(joined).size());
    put_back(step.first + done, step.first + step.count);
    missing_ -= done;
    job_.done(step.first, joined);
}

// Of several, one may be to blame: each is tried alone.
void ShardDealer::set_aside(const Bundle<Step>& bundle, const std::string& why) {
    const Step& step = bundle.questions->front();
    if (step.count == 1) {
        error_ = Error(job_.node, why);
        return;
    }
    for (auto shard = step.first + step.count; shard-- > step.first;) alone_.push_back(shard);
}

}  // namespace lightnet
