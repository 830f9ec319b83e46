#include "core/prepare/calls.hpp"

#include "core/error.hpp"
#include "core/light/mapped.hpp"

namespace lightnet {
namespace {

constexpr std::size_t most_per_place = 2;  // a shard that is done and one that waits
constexpr std::uint8_t most_copies = 2;

}  // namespace

Call::Call(const Report& what, bool rehearsed) : what_(what), rehearsed_(rehearsed) {
    if (what.kind != Report::Kind::map) return;
    shards_.resize(what.count);
    copies_.resize(what.count);
    answered_.resize(what.count);
    missing_ = what.count;
    for (std::uint32_t shard = 0; shard < what.count; ++shard) to_do_.push_back(shard);
    if (what.count == 0) complete_from_shards();
}

Bytes Call::join(const std::vector<std::vector<std::byte>>& shards) { return join_shards(shards); }

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
    if (result_ || answered_[shard]) return;
    if (--copies_[shard] == 0) to_do_.push_front(shard);
}

bool Call::answer(std::uint32_t shard, const Bytes& results) {
    if (result_ || answered_[shard]) return false;
    answered_[shard] = true;
    if (results) shards_[shard] = *results;
    return --missing_ == 0;
}

void Call::complete(Bytes result) {
    result_ = std::move(result);
    name_ = content_hash(*result_);
    shards_ = {};
    missing_ = 0;
}

Call& Calls::reported(std::size_t node, const Report& at) {
    if (const auto known = calls_.find({node, at.call}); known != calls_.end()) {
        if (known->second.what() != at)
            throw Error("'" + graph_.nodes[node].name + "' does not prepare alike on all places: its call " +
                        std::to_string(at.call) + " differs");
        return known->second;
    }
    const bool rehearsed = at.kind == Report::Kind::rehearse || (at.call > 0 && of(node, at.call - 1).rehearsed());
    auto& call = calls_[{node, at.call}] = Call(at, rehearsed);
    if (cache_ && !call.result())
        if (auto known = cache_->find(recipes_.of(node, at.call, rehearsed))) call.complete(std::move(known));
    return call;
}

void Calls::keep(std::size_t node, std::uint32_t number) {
    const auto& call = of(node, number);
    if (cache_) cache_->keep(recipes_.of(node, number, call.rehearsed()), call.result());
}

std::map<std::string, Hash> Calls::hashes() const {
    std::map<std::string, std::string> texts;
    for (const auto& [key, call] : calls_)
        if (call.result()) texts[graph_.nodes[key.first].name] += to_hex(call.name());
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
        if (key.first == node && !call.result()) return &call;
    return nullptr;
}

}  // namespace lightnet
