#include "transport/daemon/run_results.hpp"

#include <algorithm>
#include <span>
#include <system_error>

#include "core/base/error.hpp"

namespace lightnet {
namespace {

using packet::Fields;
using packet::Type;

constexpr std::uint64_t most_given_at_once = 256 << 10;  // bytes
constexpr std::size_t most_held_for_others = 2;          // results
constexpr std::size_t most_wishes = 1024;                // for one that is still being read
constexpr auto held_for_others = std::chrono::seconds(5);

bool is_ready(const std::future<Bytes>& future) {
    return future.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
}

}  // namespace

void RunResults::expect(const Hash& hash, std::uint64_t size, std::vector<std::string> holders) {
    if (results_->in_memory(hash)) return has(hash);
    auto& expected = expected_[hash];
    expected.size = size;
    expected.holders = std::move(holders);
    if (!looked_for_.contains(hash))
        looked_for_[hash] = background_.start([results = results_, hash] { return results->read(hash); });
}

void RunResults::has(const Hash& hash) {
    expected_.erase(hash);
    ways_.launcher(Type::here, Fields{}.set("hash", to_hex(hash)));
}

void RunResults::lacks(const Hash& hash) { ways_.launcher(Type::lacks, Fields{}.set("hash", to_hex(hash))); }

void RunResults::look() {
    for (auto look = looked_for_.begin(); look != looked_for_.end();) {
        if (!is_ready(look->second)) {
            ++look;
            continue;
        }
        const auto hash = look->first;
        auto bytes = look->second.get();
        look = looked_for_.erase(look);
        const auto expected = expected_.find(hash);
        if (expected == expected_.end()) continue;
        if (bytes)
            results_->take(hash, std::move(bytes)), has(hash);
        else if (const auto near = ways_.nearest(expected->second.holders); !near.empty())
            from_others_.want(hash, expected->second.size, near);
        else
            lacks(hash);
    }
}

bool RunResults::take(const packet::Piece& piece) {
    const auto expected = expected_.find(piece.hash);
    if (expected == expected_.end()) return false;
    auto& result = expected->second;
    if (!result.arriving || result.arriving->size() != result.size) result.arriving.emplace(piece.hash, result.size);
    const auto arrival = result.arriving->take(piece.offset, piece.bytes);
    if (arrival == Arrival::under_way) return true;
    if (arrival == Arrival::too_long) throw Error("a result is longer than it was said to be");
    if (arrival == Arrival::damaged) throw Error("a result of preparing arrived damaged");
    results_->keep(piece.hash, result.arriving->bytes());
    has(piece.hash);
    return true;
}

void RunResults::arrived(const std::string& host, const Frames& frames) {
    const auto body = bytes_of(frames[1]);
    const auto header = packet::read_header(bytes_of(frames[0]), body);
    if (!header || header->run != ways_.run) return;
    if (header->type == Type::blob) {
        if (const auto piece = packet::unpack_piece(body))
            from_others_.take(host, *piece, std::chrono::steady_clock::now());
    } else if (header->type == Type::lacks) {
        const auto fields = packet::unpack_fields(body);
        if (const auto hash = fields ? hash_from_hex(fields->text("hash")) : std::nullopt)
            from_others_.lacks(host, *hash);
    }
}

// Lets go of what was asked for longest ago, if need be; not of what is still being read.
bool RunResults::has_room_for_others() {
    if (given_.size() < most_held_for_others) return true;
    auto oldest = given_.end();
    for (auto one = given_.begin(); one != given_.end(); ++one)
        if (!one->second.reading.valid() && (oldest == given_.end() || one->second.used < oldest->second.used))
            oldest = one;
    if (oldest == given_.end()) return false;
    given_.erase(oldest);
    return true;
}

void RunResults::asked(Frames frames) {
    const auto body = bytes_of(frames[3]);
    const auto header = packet::read_header(bytes_of(frames[2]), body);
    const auto fields = header && header->run == ways_.run ? packet::unpack_fields(body) : std::nullopt;
    const auto hash = fields ? hash_from_hex(fields->text("hash")) : std::nullopt;
    if (!hash) return;
    frames.resize(2);
    Wish wish{std::move(frames), fields->number("offset"), fields->number("size")};
    auto found = given_.find(*hash);
    if (found == given_.end()) {
        if (!has_room_for_others()) return give(*hash, std::move(wish), nullptr);
        Given begun;
        if (results_->in_memory(*hash)) {
            begun.bytes = results_->find(*hash);
        } else {
            try {
                begun.reading = background_.start([results = results_, name = *hash] { return results->find(name); });
            } catch (const std::system_error&) {  // no thread is to be had
                return give(*hash, std::move(wish), nullptr);
            }
        }
        found = given_.emplace(*hash, std::move(begun)).first;
    }
    auto& given = found->second;
    given.used = std::chrono::steady_clock::now();
    if (given.reading.valid() && given.wishes.size() < most_wishes) return given.wishes.push_back(std::move(wish));
    give(*hash, std::move(wish), given.bytes);
}

void RunResults::give(const Hash& hash, Wish wish, const Bytes& bytes) {
    auto frames = std::move(wish.way);
    if (!bytes || wish.offset >= bytes->size()) {
        append(frames, packet::pack(Type::lacks, ways_.run, Fields{}.set("hash", to_hex(hash))));
    } else {
        const auto size = std::min({wish.size, most_given_at_once, bytes->size() - wish.offset});
        append(frames, packet::pack(ways_.run, {hash, wish.offset, std::span(*bytes).subspan(wish.offset, size)}));
    }
    ways_.reply(frames);
}

void RunResults::go_on(Time now) {
    look();
    for (auto& [hash, given] : given_)
        if (given.reading.valid() && is_ready(given.reading)) {
            given.bytes = given.reading.get();
            for (auto& wish : std::exchange(given.wishes, {})) give(hash, std::move(wish), given.bytes);
        }
    std::erase_if(given_, [&](const auto& one) {
        const auto& given = one.second;
        return !given.reading.valid() && (!given.bytes || now - given.used > held_for_others);
    });
    from_others_.go_on(now, [this](const ResultsFromOthers::Ask& ask) {
        if (ways_.nearest({ask.host}).empty()) return false;
        Frames frames;
        frames.emplace_back();
        frames.emplace_back(ask.host);
        append(frames,
               packet::pack(Type::fetch, ways_.run,
                            Fields{}.set("hash", to_hex(ask.hash)).set("offset", ask.offset).set("size", ask.size)));
        ways_.ask(std::move(frames));
        return true;
    });
    for (const auto& [host, why] : from_others_.troubles())
        ways_.warn("asks " + host + " for no results any more: " + why);
    for (auto& [hash, bytes] : from_others_.outcomes()) {
        if (!expected_.contains(hash)) continue;
        if (!bytes)
            lacks(hash);
        else
            results_->keep(hash, std::move(bytes)), has(hash);
    }
}

}  // namespace lightnet
