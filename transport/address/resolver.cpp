#include "transport/address/resolver.hpp"

#include <algorithm>
#include <condition_variable>
#include <deque>
#include <map>
#include <mutex>
#include <optional>
#include <system_error>
#include <thread>
#include <utility>

#include "core/base/patience.hpp"
#include "core/base/words_of.hpp"

namespace lightnet {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int most_threads = 32;                         // that look up at once; others wait
constexpr auto patience = std::chrono::seconds(3);       // until it is said that nobody answers
constexpr auto after_failure = std::chrono::seconds(1);  // before a name is asked again of which nobody knew
constexpr std::size_t most_names = 65536;                // that are kept

std::optional<Whereabout> known_without_asking(const std::string& host) {
    if (host == own_machine)
        return Whereabout{Whereabout::State::found, {*ip_address("127.0.0.1"), *ip_address("::1")}, {}};
    if (const auto address = ip_address(host)) return Whereabout{Whereabout::State::found, {*address}, {}};
    return std::nullopt;
}

// Nobody is there to catch anything.
Whereabout looked_up(const NameService& service, const std::string& name) {
    try {
        return service.look_up(name);
    } catch (const std::exception& error) {
        return {Whereabout::State::unknown, {}, "nobody says where '" + name + "' is: " + words_of(error)};
    }
}

}  // namespace

/// What lookups write to.
struct Resolver::Desk {
    std::map<std::string, IpAddress> answering;  // by endpoint
    struct Entry {
        Whereabout known;
        Time since{};  // when it became known
        Time asked{};  // last
        bool asking = false;
    };
    std::shared_ptr<const NameService> service;
    std::mutex mutex;
    std::condition_variable answered;
    std::map<std::string, Entry> names;
    std::deque<std::string> waiting;
    int threads = 0;

    void begin(const std::string& name, Entry& entry, Time now, const std::shared_ptr<Desk>& self);
    void work();
    Whereabout said_of(const std::string& name, const Entry& entry, Time now) const;
};

// With the mutex held. The thread belongs to nobody: a lookup can't be called off, and nobody is to wait for one that
// hangs, not even the end of the process.
void Resolver::Desk::begin(const std::string& name, Entry& entry, Time now, const std::shared_ptr<Desk>& self) {
    entry.asking = true;
    entry.asked = now;
    waiting.push_back(name);
    if (threads >= most_threads) return;
    try {
        std::thread([self] { self->work(); }).detach();
        ++threads;
    } catch (const std::system_error&) {
        if (threads > 0) return;  // one of them will do it
        waiting.clear();
        for (auto& [ignored, one] : names) one.asking = false;
    }
}

void Resolver::Desk::work() {
    std::unique_lock lock(mutex);
    while (!waiting.empty()) {
        const std::string name = std::move(waiting.front());
        waiting.pop_front();
        lock.unlock();
        auto found = looked_up(*service, name);
        lock.lock();
        auto& entry = names[name];
        if (found.addresses.empty()) found.addresses = std::move(entry.known.addresses);
        entry.known = std::move(found);
        entry.since = Clock::now();
        entry.asking = false;
        answered.notify_all();
    }
    --threads;
}

Whereabout Resolver::Desk::said_of(const std::string& name, const Entry& entry, Time now) const {
    auto known = entry.known;
    if (!entry.asking || now - entry.asked < patience) return known;
    known.state = Whereabout::State::unknown;
    known.why = "no name server says where '" + name + "' is";
    return known;
}

Resolver::Resolver(std::shared_ptr<const NameService> service) : desk_(std::make_shared<Desk>()) {
    desk_->service = std::move(service);
}

Resolver::~Resolver() {
    const std::lock_guard lock(desk_->mutex);
    desk_->waiting.clear();
}

Whereabout Resolver::look(const std::string& host, Time now, std::chrono::milliseconds fresh) {
    if (auto known = known_without_asking(host)) return *known;
    const std::lock_guard lock(desk_->mutex);
    if (desk_->names.size() >= most_names && !desk_->names.contains(host))
        return {Whereabout::State::unknown, {}, "too many names are asked for: '" + host + "' is not"};
    auto& entry = desk_->names[host];
    const bool first = entry.known.state == Whereabout::State::asked;
    const auto least = std::max<std::chrono::milliseconds>(fresh, after_failure);
    if (!entry.asking && (first ? now - entry.asked > after_failure : now - entry.since > least))
        desk_->begin(host, entry, now, desk_);
    return desk_->said_of(host, entry, now);
}

void Resolver::remember(const std::string& endpoint, const IpAddress& address) {
    const std::lock_guard lock(desk_->mutex);
    if (desk_->answering.size() < most_names) desk_->answering[endpoint] = address;
}

std::optional<IpAddress> Resolver::remembered(const std::string& endpoint) const {
    const std::lock_guard lock(desk_->mutex);
    const auto found = desk_->answering.find(endpoint);
    return found == desk_->answering.end() ? std::nullopt : std::optional(found->second);
}

Whereabout Resolver::wait_for(const std::string& host, std::chrono::milliseconds most) {
    Patience left(most);
    auto known = look(host, Clock::now());
    std::unique_lock lock(desk_->mutex, std::defer_lock);
    while (known.state == Whereabout::State::asked && !left.is_over()) {
        lock.lock();
        desk_->answered.wait_for(lock, std::min(left.until_look(), std::chrono::milliseconds(100)));
        lock.unlock();
        known = look(host, Clock::now());
    }
    if (known.state != Whereabout::State::asked) return known;
    return {Whereabout::State::unknown, {}, "no name server says where '" + host + "' is"};
}

}  // namespace lightnet
