#include "transport/daemon/results_from_others.hpp"

#include <algorithm>
#include <set>

namespace lightnet {
namespace {

constexpr std::size_t most_holders = 2;  // that are asked for one result
constexpr std::size_t most_asked = 4 << 20, largest_piece_asked = 256 << 10;
constexpr auto patience_for_pieces = std::chrono::seconds(2);  // with a host that says nothing
// A host is far too slow if after so long it would need so much longer.
constexpr auto fair_try = std::chrono::seconds(3);
constexpr double most_seconds_left = 15;

}  // namespace

void ResultsFromOthers::want(const Hash& hash, std::uint64_t size, const std::vector<std::string>& holders) {
    if (std::ranges::any_of(wanted_, [&](const auto& other) { return other.hash == hash; })) return;
    Wanted wanted{.hash = hash, .size = size, .holders = {}};
    for (const auto& host : holders) {
        auto& holder = holders_.try_emplace(host, Holder{LinePace(most_asked, largest_piece_asked)}).first->second;
        if (!holder.left && wanted.holders.size() < most_holders) wanted.holders.push_back(host);
    }
    if (size == 0) wanted.holders.clear();
    if (wanted.holders.empty()) return outcomes_.push_back({hash, nullptr});
    wanted_.push_back(std::move(wanted));
}

// One result of each host at a time: so pieces come in the order in which they were asked for.
void ResultsFromOthers::go_on(Time now, const Send& send) {
    std::set<std::string> busy;
    for (auto next = wanted_.begin(); next != wanted_.end();) {
        auto& wanted = *next++;
        const auto host = wanted.holders.front();
        if (busy.contains(host)) continue;
        if (const auto why = too_slow(wanted, now); !why.empty())
            leave(wanted, why);
        else if (!ask(wanted, holders_.at(host), now, send))
            ask_next(wanted);
        else
            busy.insert(host);
    }
    std::erase_if(wanted_, [](const auto& wanted) { return wanted.holders.empty(); });
}

// False: it can't be reached.
bool ResultsFromOthers::ask(Wanted& wanted, Holder& holder, Time now, const Send& send) const {
    if (wanted.asked == 0) {
        wanted.arriving.emplace(wanted.hash, wanted.size);
        wanted.begun = wanted.heard = now;
    }
    while (wanted.asked < wanted.size) {
        const auto size = std::min<std::uint64_t>(holder.pace.piece(), wanted.size - wanted.asked);
        if (!holder.pace.may_send(size)) return true;
        if (!send({wanted.holders.front(), wanted.hash, wanted.asked, size})) return false;
        if (wanted.asked == wanted.arriving->here()) wanted.heard = now;
        holder.pace.sent_piece(size, now);
        wanted.asked += size;
    }
    return true;
}

std::string ResultsFromOthers::too_slow(const Wanted& wanted, Time now) const {
    if (wanted.asked == 0) return {};
    if (now - wanted.heard > patience_for_pieces) return "it does not answer";
    const std::chrono::duration<double> since = now - wanted.begun;
    if (since < fair_try) return {};
    const auto came = static_cast<double>(wanted.arriving->here());
    const double left = static_cast<double>(wanted.size) - came;
    return left * since.count() > most_seconds_left * came ? "it is too slow" : "";
}

// The next host of those that have it; none: the launcher.
void ResultsFromOthers::ask_next(Wanted& wanted) {
    if (wanted.asked > 0) holders_.at(wanted.holders.front()).pace.restart();
    do {
        wanted.holders.pop_front();
    } while (!wanted.holders.empty() && holders_.at(wanted.holders.front()).left);
    wanted.arriving.reset(), wanted.asked = 0;
    if (wanted.holders.empty()) outcomes_.push_back({wanted.hash, nullptr});
}

void ResultsFromOthers::leave(Wanted& wanted, const std::string& why) {
    holders_.at(wanted.holders.front()).left = true;
    troubles_.push_back({wanted.holders.front(), why});
    ask_next(wanted);
}

ResultsFromOthers::Place ResultsFromOthers::find(const std::string& from, const Hash& hash) {
    return std::ranges::find_if(wanted_, [&](const Wanted& wanted) {
        return wanted.hash == hash && wanted.asked > 0 && wanted.holders.front() == from;
    });
}

void ResultsFromOthers::take(const std::string& from, const packet::Piece& piece, Time now) {
    const auto found = find(from, piece.hash);
    if (found == wanted_.end() || piece.offset != found->arriving->here() || piece.bytes.empty()) return;
    auto& wanted = *found;
    if (piece.bytes.size() > wanted.asked - piece.offset) {
        leave(wanted, "it gave more than it was asked for");
    } else {
        holders_.at(from).pace.piece_taken(now);
        wanted.heard = now;
        const auto arrival = wanted.arriving->take(piece.offset, piece.bytes);
        if (arrival == Arrival::under_way) return;
        if (arrival != Arrival::whole) {
            leave(wanted, "what it gave is not what its hash says");
        } else {
            outcomes_.push_back({wanted.hash, wanted.arriving->bytes()});
            wanted.holders.clear();
        }
    }
    if (wanted.holders.empty()) wanted_.erase(found);
}

void ResultsFromOthers::lacks(const std::string& from, const Hash& hash) {
    const auto found = find(from, hash);
    if (found == wanted_.end()) return;
    ask_next(*found);
    if (found->holders.empty()) wanted_.erase(found);
}

void ResultsFromOthers::lose(const std::string& host) {
    for (auto& wanted : wanted_)
        if (wanted.asked > 0 && wanted.holders.front() == host) ask_next(wanted);
    std::erase_if(wanted_, [](const auto& wanted) { return wanted.holders.empty(); });
}

}  // namespace lightnet
