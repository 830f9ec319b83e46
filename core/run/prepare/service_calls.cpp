#include "core/run/prepare/service_calls.hpp"

#include <algorithm>
#include <utility>

#include "core/base/error.hpp"
#include "core/network/light/mapped.hpp"
#include "core/run/schedule/guided.hpp"

namespace lightnet {
namespace {

constexpr std::size_t most_per_place = 2;  // asks: one that is worked at and one that waits
constexpr std::uint8_t most_copies = 2;
constexpr std::size_t shares = 3;  // for each place, see guided_share()
// Speculative execution, as Scheduler has it for questions, but sooner: shards are alike, so a late one stands out, and
// all places wait for the last.
constexpr double late_factor = 2;        // times as long as others
constexpr double least_late = 0.01;      // seconds
constexpr double patience_at_first = 1;  // seconds, as long as nobody has answered

}  // namespace

ServiceCall::ServiceCall(const StepReport& what, bool rehearsed, std::uint32_t parts)
    : what_(what), rehearsed_(rehearsed), kept_(parts), lent_(parts) {
    begin_again();
}

void ServiceCall::begin_again() {
    names_.clear();
    if (!shared_out()) return;
    to_do_.clear();
    shards_.assign(what_.count, {});
    copies_.assign(what_.count, 0);
    answered_.assign(what_.count, false);
    begun_.assign(what_.count, 0);
    seconds_ = 0;
    joined_.clear();
    for (std::uint32_t part = 0; part < parts(); ++part) joined_.push_back({ShardJoiner(what_.count), {}});
    next_ = 0;
    missing_ = what_.count;
    for (std::uint32_t shard = 0; shard < what_.count; ++shard) to_do_.push_back(shard);
    if (what_.count == 0) complete_from_shards();
}

std::optional<Shards> ServiceCall::hand_out(const Asker& asker) {
    if (asker.under_way >= most_per_place || missing_ == 0) return std::nullopt;
    // The last ones go to who is idle first: behind others they would wait longer.
    if (asker.under_way > 0 && to_do_.size() <= asker.places) return std::nullopt;
    if (!to_do_.empty()) {
        const auto most = std::max<std::size_t>(1, guided_share(to_do_.size(), asker.places, shares));
        Shards some{to_do_.front(), 0};
        while (!to_do_.empty() && to_do_.front() == some.first + some.count && some.count < most) {
            if (++copies_[to_do_.front()] == 1) begun_[to_do_.front()] = asker.now;
            to_do_.pop_front();
            ++some.count;
        }
        return some;
    }
    // All are handed out: an idle place does once more what another one is late with, and the first result counts.
    for (std::uint32_t shard = 0; shard < answered_.size(); ++shard)
        if (!answered_[shard] && copies_[shard] < most_copies && is_late(shard, asker.now)) {
            ++copies_[shard];
            return Shards{shard, 1};
        }
    return std::nullopt;
}

bool ServiceCall::is_late(std::uint32_t shard, double now) const {
    const std::size_t done = answered_.size() - missing_;
    const double usual = done > 0 ? seconds_ / double(done) : patience_at_first / late_factor;
    return now - begun_[shard] > std::max(late_factor * usual, least_late);
}

void ServiceCall::take_back(const Shards& shards) {
    if (done()) return;
    for (auto shard = shards.first + shards.count; shard-- > shards.first;)
        if (!answered_[shard] && copies_[shard] > 0 && --copies_[shard] == 0) to_do_.push_front(shard);
}

bool ServiceCall::answer(const Shards& shards, const Bytes& joined, double now) {
    if (done()) return false;
    const auto results = split_shards(joined);
    if (results.empty() || results.size() > shards.count)
        throw Error("results of preparing", "they are not of the shards that were asked for");
    for (std::uint32_t i = 0; i < results.size(); ++i) take({joined, results[i]}, shards.first + i, now);
    const auto some = static_cast<std::uint32_t>(results.size());
    take_back({shards.first + some, shards.count - some});
    join_what_is_next();
    return missing_ == 0;
}

void ServiceCall::take(const Results& results, std::uint32_t shard, double now) {
    if (answered_[shard]) return;
    if (what_.kind == StepReport::Kind::sectors && split_shards(results.own).size() != parts())
        throw Error("results of preparing", "they are not for as many sectors as there are");
    answered_[shard] = true;
    seconds_ += now - begun_[shard];
    shards_[shard] = results;
    --missing_;
}

std::vector<std::span<const std::byte>> ServiceCall::parts_of(const Results& shard) const {
    if (what_.kind == StepReport::Kind::sectors) return split_shards(shard.own);
    return {shard.own};
}

// While places still work; at the end they would wait for it.
void ServiceCall::join_what_is_next() {
    for (; next_ < shards_.size() && answered_[next_]; ++next_) {
        const Results shard = std::exchange(shards_[next_], {});
        const auto spans = parts_of(shard);
        for (std::size_t part = 0; part < spans.size(); ++part) {
            joined_[part].results.add(spans[part]);
            joined_[part].hasher.add(spans[part]);
        }
    }
}

void ServiceCall::complete(const std::vector<Result>& parts) {
    for (std::size_t part = 0; part < parts.size(); ++part) {
        lent_[part] = kept_[part] = parts[part].bytes;
        names_.push_back(parts[part].name);
    }
    shards_ = {};
    joined_.clear();
    missing_ = 0;
}

void ServiceCall::complete_from_shards() {
    std::vector<Result> results;
    for (auto& [joiner, hasher] : joined_) {
        hasher.add(joiner.tail());
        results.push_back({hasher.finish(), joiner.finish()});
    }
    complete(results);
}

void ServiceCall::let_go() { kept_.assign(kept_.size(), nullptr); }

bool ServiceCall::restore(std::uint32_t part, const Result& result) {
    if (!result.bytes || result.name != names_[part]) return false;
    lent_[part] = kept_[part] = result.bytes;
    return true;
}

ServiceCall& ServiceCalls::reported(std::size_t node, const StepReport& at) {
    const std::size_t whole = whole_of(graph_, node);
    if (const auto known = calls_.find({whole, at.call}); known != calls_.end()) {
        if (known->second.what() != at)
            throw Error("'" + graph_.nodes[whole].name + "' does not prepare alike on all places: its call " +
                        std::to_string(at.call) + " differs");
        return known->second;
    }
    const auto* sector = sector_at(graph_, node);
    if (at.kind == StepReport::Kind::sectors && !sector)
        throw Error("'" + graph_.nodes[whole].name + "' prepares for sectors, but has none");
    const bool rehearsed = at.kind == StepReport::Kind::rehearse || (at.call > 0 && of(whole, at.call - 1).rehearsed());
    auto& call = calls_[{whole, at.call}] =
        ServiceCall(at, rehearsed, at.kind == StepReport::Kind::sectors ? sector->count : 1);
    if (!cache_ || call.done()) return call;
    std::vector<Result> parts;
    for (std::uint32_t part = 0; part < call.parts(); ++part) {
        parts.push_back(cache_->find(recipe_of(whole, at.call, call, part)));
        if (!parts.back().bytes) return call;
    }
    call.complete(parts);
    return call;
}

Hash ServiceCalls::recipe_of(std::size_t whole, std::uint32_t number, const ServiceCall& call,
                             std::uint32_t part) const {
    const std::string which = call.what().kind == StepReport::Kind::sectors
                                  ? "\nsector " + std::to_string(part + 1) + " of " + std::to_string(call.parts())
                                  : std::string();
    return recipes_.of(whole, number, call.rehearsed(), which);
}

std::uint32_t ServiceCalls::part_of(std::size_t node, const ServiceCall& call) const {
    const auto* sector = sector_at(graph_, node);
    return sector && call.what().kind == StepReport::Kind::sectors ? sector->index : 0;
}

Bytes ServiceCalls::result(std::size_t node, std::uint32_t number) {
    auto& call = of(node, number);
    if (!call.done()) return nullptr;
    const auto part = part_of(node, call);
    if (auto known = call.result(part)) return known;
    if (cache_ && call.restore(part, cache_->find(recipe_of(whole_of(graph_, node), number, call, part))))
        return call.result(part);
    call.begin_again();
    return nullptr;
}

void ServiceCalls::keep(std::size_t node, std::uint32_t number) {
    const auto& call = of(node, number);
    for (std::uint32_t part = 0; cache_ && part < call.parts(); ++part)
        cache_->keep(recipe_of(whole_of(graph_, node), number, call, part), {call.name(part), call.result(part)});
}

void ServiceCalls::all_have(std::size_t node, std::uint32_t number) {
    auto& call = of(node, number);
    if (cache_ && call.done() && call.what().kind == StepReport::Kind::sectors) call.let_go();
}

std::map<std::string, Hash> ServiceCalls::hashes() const {
    std::map<std::string, std::string> texts;
    for (const auto& [key, call] : calls_)
        for (std::uint32_t part = 0; call.done() && part < call.parts(); ++part)
            texts[graph_.nodes[key.first].name] += to_hex(call.name(part));
    std::map<std::string, Hash> hashes;
    for (const auto& [name, text] : texts) hashes[name] = content_hash(text);
    return hashes;
}

Bytes ServiceCalls::last_result(std::size_t node) const {
    Bytes last;
    for (const auto& [key, call] : calls_)
        if (key.first == node && call.result()) last = call.result();
    return last;
}

const ServiceCall* ServiceCalls::unfinished(std::size_t node) const {
    for (const auto& [key, call] : calls_)
        if (key.first == node && !call.done()) return &call;
    return nullptr;
}

}  // namespace lightnet
