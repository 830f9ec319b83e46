#include "core/prepare/calls.hpp"

#include "core/error.hpp"
#include "core/light/mapped.hpp"

namespace lightnet {
namespace {

constexpr std::size_t most_per_place = 2;  // a shard that is done and one that waits
constexpr std::uint8_t most_copies = 2;

}  // namespace

Call::Call(const Report& what, bool rehearsed, std::uint32_t parts)
    : what_(what), rehearsed_(rehearsed), kept_(parts), lent_(parts) {
    begin_again();
}

void Call::begin_again() {
    names_.clear();
    if (!shared_out()) return;
    to_do_.clear();
    shards_.assign(what_.count, nullptr);
    copies_.assign(what_.count, 0);
    answered_.assign(what_.count, false);
    hashers_ = std::vector<Hasher>(parts());
    hashed_ = 0;
    missing_ = what_.count;
    for (std::uint32_t shard = 0; shard < what_.count; ++shard) to_do_.push_back(shard);
    if (what_.count == 0) complete_from_shards();
}

std::optional<std::uint32_t> Call::hand_out(std::size_t under_way) {
    if (under_way >= most_per_place || missing_ == 0) return std::nullopt;
    if (!to_do_.empty()) {
        const auto shard = to_do_.front();
        to_do_.pop_front();
        ++copies_[shard];
        return shard;
    }
    if (under_way > 0) return std::nullopt;
    // Nothing is left but what others do: whoever is idle does it, too, and the first result counts.
    for (std::uint32_t shard = 0; shard < answered_.size(); ++shard)
        if (!answered_[shard] && copies_[shard] < most_copies) {
            ++copies_[shard];
            return shard;
        }
    return std::nullopt;
}

void Call::take_back(std::uint32_t shard) {
    if (done() || answered_[shard] || copies_[shard] == 0) return;
    if (--copies_[shard] == 0) to_do_.push_front(shard);
}

bool Call::answer(std::uint32_t shard, const Bytes& results) {
    if (done() || answered_[shard]) return false;
    if (what_.kind == Report::Kind::sectors && split_shards(results).size() != parts())
        throw Error("results of preparing", "they are not for as many sectors as there are");
    answered_[shard] = true;
    shards_[shard] = results;
    hash_what_is_next();
    return --missing_ == 0;
}

std::vector<std::span<const std::byte>> Call::parts_of(const Bytes& shard) const {
    if (what_.kind == Report::Kind::sectors) return split_shards(shard);
    return {shard ? std::span<const std::byte>(*shard) : std::span<const std::byte>()};
}

// While places still work; at the end they would wait for it.
void Call::hash_what_is_next() {
    for (; hashed_ < shards_.size() && answered_[hashed_]; ++hashed_) {
        const auto spans = parts_of(shards_[hashed_]);
        for (std::size_t part = 0; part < spans.size(); ++part) hashers_[part].add(spans[part]);
    }
}

void Call::complete(const std::vector<Result>& parts) {
    for (std::size_t part = 0; part < parts.size(); ++part) {
        lent_[part] = kept_[part] = parts[part].bytes;
        names_.push_back(parts[part].name);
    }
    shards_ = {};
    missing_ = 0;
}

// In the order of shards, each part by itself.
void Call::complete_from_shards() {
    std::vector<std::vector<std::span<const std::byte>>> lists(parts());
    for (const auto& shard : shards_) {
        const auto spans = parts_of(shard);
        for (std::size_t part = 0; part < lists.size(); ++part) lists[part].push_back(spans[part]);
    }
    std::vector<Result> results;
    for (std::size_t part = 0; part < lists.size(); ++part) {
        auto joined = join_shards(std::span(lists[part]));
        hashers_[part].add(std::span(*joined).last(tail_of_joined(lists[part].size())));
        results.push_back({hashers_[part].finish(), std::move(joined)});
    }
    hashers_.clear();
    complete(results);
}

void Call::let_go() { kept_.assign(kept_.size(), nullptr); }

bool Call::restore(std::uint32_t part, const Result& result) {
    if (!result.bytes || result.name != names_[part]) return false;
    lent_[part] = kept_[part] = result.bytes;
    return true;
}

Call& Calls::reported(std::size_t node, const Report& at) {
    const std::size_t whole = whole_of(graph_, node);
    if (const auto known = calls_.find({whole, at.call}); known != calls_.end()) {
        if (known->second.what() != at)
            throw Error("'" + graph_.nodes[whole].name + "' does not prepare alike on all places: its call " +
                        std::to_string(at.call) + " differs");
        return known->second;
    }
    const auto* sector = sector_at(graph_, node);
    if (at.kind == Report::Kind::sectors && !sector)
        throw Error("'" + graph_.nodes[whole].name + "' prepares for sectors, but has none");
    const bool rehearsed = at.kind == Report::Kind::rehearse || (at.call > 0 && of(whole, at.call - 1).rehearsed());
    auto& call = calls_[{whole, at.call}] = Call(at, rehearsed, at.kind == Report::Kind::sectors ? sector->count : 1);
    if (!cache_ || call.done()) return call;
    std::vector<Result> parts;
    for (std::uint32_t part = 0; part < call.parts(); ++part) {
        parts.push_back(cache_->find(recipe_of(whole, at.call, call, part)));
        if (!parts.back().bytes) return call;
    }
    call.complete(parts);
    return call;
}

Hash Calls::recipe_of(std::size_t whole, std::uint32_t number, const Call& call, std::uint32_t part) const {
    const std::string which = call.what().kind == Report::Kind::sectors
                                  ? "\nsector " + std::to_string(part + 1) + " of " + std::to_string(call.parts())
                                  : std::string();
    return recipes_.of(whole, number, call.rehearsed(), which);
}

std::uint32_t Calls::part_of(std::size_t node, const Call& call) const {
    const auto* sector = sector_at(graph_, node);
    return sector && call.what().kind == Report::Kind::sectors ? sector->index : 0;
}

Bytes Calls::result(std::size_t node, std::uint32_t number) {
    auto& call = of(node, number);
    if (!call.done()) return nullptr;
    const auto part = part_of(node, call);
    if (auto known = call.result(part)) return known;
    if (cache_ && call.restore(part, cache_->find(recipe_of(whole_of(graph_, node), number, call, part))))
        return call.result(part);
    call.begin_again();
    return nullptr;
}

void Calls::keep(std::size_t node, std::uint32_t number) {
    const auto& call = of(node, number);
    for (std::uint32_t part = 0; cache_ && part < call.parts(); ++part)
        cache_->keep(recipe_of(whole_of(graph_, node), number, call, part), {call.name(part), call.result(part)});
}

void Calls::all_have(std::size_t node, std::uint32_t number) {
    auto& call = of(node, number);
    if (cache_ && call.done() && call.what().kind == Report::Kind::sectors) call.let_go();
}

std::map<std::string, Hash> Calls::hashes() const {
    std::map<std::string, std::string> texts;
    for (const auto& [key, call] : calls_)
        for (std::uint32_t part = 0; call.done() && part < call.parts(); ++part)
            texts[graph_.nodes[key.first].name] += to_hex(call.name(part));
    std::map<std::string, Hash> hashes;
    for (const auto& [name, text] : texts) hashes[name] = content_hash(text);
    return hashes;
}

Bytes Calls::last_result(std::size_t node) const {
    Bytes last;
    for (const auto& [key, call] : calls_)
        if (key.first == node && call.result()) last = call.result();
    return last;
}

const Call* Calls::unfinished(std::size_t node) const {
    for (const auto& [key, call] : calls_)
        if (key.first == node && !call.done()) return &call;
    return nullptr;
}

}  // namespace lightnet
