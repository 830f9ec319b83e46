#include "core/run/master/service_calls.hpp"

#include <utility>

#include "core/base/error.hpp"
#include "core/network/light/mapped.hpp"

namespace lightnet {

ServiceCall::ServiceCall(const StepReport& what, bool rehearsed, std::uint32_t parts)
    : what_(what), rehearsed_(rehearsed), kept_(parts), lent_(parts) {
    begin_again();
}

void ServiceCall::begin_again() {
    names_.clear();
    if (!shared_out()) return;
    shards_.assign(what_.count, {});
    answered_.assign(what_.count, false);
    joined_.clear();
    for (std::uint32_t part = 0; part < parts(); ++part) joined_.push_back({ShardJoiner(what_.count), {}});
    next_ = 0;
    missing_ = what_.count;
    if (what_.count == 0) complete_from_shards();
}

void ServiceCall::check(std::uint32_t count, const Bytes& joined) const {
    const auto results = split_shards(joined);
    if (results.empty() || results.size() > count)
        throw Error("results of preparing", "they are not of the shards that were asked for");
    for (const auto& own : results)
        if (what_.kind == StepReport::Kind::sectors && split_shards(own).size() != parts())
            throw Error("results of preparing", "they are not for as many sectors as there are");
}

void ServiceCall::take(std::uint32_t first, const Bytes& joined) {
    const auto results = split_shards(joined);
    for (std::uint32_t i = 0; i < results.size(); ++i) {
        answered_[first + i] = true;
        shards_[first + i] = {joined, results[i]};
    }
    missing_ -= results.size();
    join_what_is_next();
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
    const bool rehearsed =
        at.kind == StepReport::Kind::rehearse || (!is_first_call(at.call) && of(whole, at.call - 1).rehearsed());
    auto& call = calls_[{whole, at.call}] =
        ServiceCall(at, rehearsed, at.kind == StepReport::Kind::sectors ? sector->count : 1);
    auto* const cache = cache_for(whole);
    if (!cache || call.done()) return call;
    std::vector<Result> parts;
    for (std::uint32_t part = 0; part < call.parts(); ++part) {
        parts.push_back(cache->find(recipe_of(whole, at.call, call, part)));
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
    const std::size_t whole = whole_of(graph_, node);
    auto* const cache = cache_for(whole);
    if (cache && call.restore(part, cache->find(recipe_of(whole, number, call, part)))) return call.result(part);
    call.begin_again();
    return nullptr;
}

void ServiceCalls::keep(std::size_t node, std::uint32_t number) {
    const auto& call = of(node, number);
    const std::size_t whole = whole_of(graph_, node);
    auto* const cache = cache_for(whole);
    for (std::uint32_t part = 0; cache && part < call.parts(); ++part)
        cache->keep(recipe_of(whole, number, call, part), {call.name(part), call.result(part)});
}

void ServiceCalls::forget(std::size_t node) {
    std::erase_if(calls_, [&](const auto& call) { return call.first.first == node; });
}

void ServiceCalls::all_have(std::size_t node, std::uint32_t number) {
    auto& call = of(node, number);
    if (cache_for(whole_of(graph_, node)) && call.done() && call.what().kind == StepReport::Kind::sectors)
        call.let_go();
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

std::vector<std::pair<std::uint32_t, ServiceCall*>> ServiceCalls::dealt_out(std::size_t node) {
    std::vector<std::pair<std::uint32_t, ServiceCall*>> calls;
    for (auto call = calls_.lower_bound({node, 0}); call != calls_.end() && call->first.first == node; ++call)
        if (!call->second.done() && call->second.shared_out()) calls.emplace_back(call->first.second, &call->second);
    return calls;
}

const ServiceCall* ServiceCalls::unfinished(std::size_t node) const {
    for (const auto& [key, call] : calls_)
        if (key.first == node && !call.done()) return &call;
    return nullptr;
}

}  // namespace lightnet
